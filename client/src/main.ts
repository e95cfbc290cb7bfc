/** The page's start: its scene, its data, and the errors that stop it, each as one sentence on the page. */

import { Archive, needPages, openParts, readArchive } from "./archive";
import { unpacked } from "./packed";
import { PAGE_BITS, fromBase64 } from "./engine";
import { Controls } from "./controls";
import { attachMouse } from "./mouse";
import { attachNotebook } from "./notebook";
import { Remote } from "./remote";
import { Renderer } from "./renderer";
import type { Scene } from "./scene";

const text = (id: string): string => document.getElementById(id)?.textContent ?? "";

/** Pages of 2^14 fiblets in one request: some 4 MB. */
const STRIDE = 4;

interface Loading {
  archive: Archive;
  remote: Remote;
  values: string[];
}

async function dataOf(scene: Scene): Promise<Uint8Array[]> {
  const sets = new Set(scene.layers.map((layer) => (layer.kind === "fiblets" ? layer.data : -1)));
  return Promise.all(scene.data.map(async (said, i) => {
    if (said.file === undefined) return fromBase64(text(`data-${i}`).trim());
    if (sets.has(i)) return new Uint8Array();
    const remote = new Remote(said.file, said.bytes);
    await remote.need(0, said.bytes);
    return remote.bytes;
  }));
}

/** Open the sets of fiblets; sets beside the page have yet to arrive. */
async function archivesOf(scene: Scene, data: Uint8Array[], loading: Loading[]): Promise<Map<number, Archive>> {
  const found = new Map<number, Archive>();
  await Promise.all(scene.layers.map(async (layer) => {
    if (layer.kind !== "fiblets") return;
    const { file, bytes } = scene.data[layer.data];
    if (file === undefined) {
      found.set(layer.data, await unpacked(readArchive(data[layer.data])));
      return;
    }
    const remote = new Remote(file, bytes), values = layer.colours.values === undefined ? [] : [layer.colours.values];
    const archive = await openParts(remote, values);
    found.set(layer.data, archive);
    loading.push({ archive, remote, values });
  }));
  return found;
}

/** Load all streamlines, piece by piece, and show each piece once it has arrived. */
async function load(loading: Loading[], renderer: Renderer): Promise<void> {
  const bar = document.createElement("progress"), perPage = 1 << PAGE_BITS;
  bar.setAttribute("aria-label", "Streamlines that have come");
  bar.max = loading.reduce((sum, { archive }) => sum + archive.header.n_fiblets, 0);
  document.getElementById("over")!.append(bar);
  await Promise.all(loading.map(async ({ archive, remote, values }) => {
    const n: number = archive.header.n_fiblets, pages = Math.ceil(n / perPage);
    const piece = (page: number): Promise<void> => needPages(remote, archive, page, Math.min(page + STRIDE, pages), perPage, values);
    let next = piece(0);
    for (let page = 0; page < pages; page += STRIDE) {
      const here = next;
      if (page + STRIDE < pages) (next = piece(page + STRIDE)).catch(() => undefined);
      await here;
      bar.value += Math.min((page + STRIDE) * perPage, n) - archive.ready;
      archive.ready = Math.min((page + STRIDE) * perPage, n);
      renderer.grow();
    }
  }));
  bar.remove();
}

function fail(error: unknown): void {
  const place = document.getElementById("message")!;
  place.textContent = error instanceof Error ? error.message : String(error);
  place.hidden = false;
  document.body.dataset.state = "failed";
}

async function start(): Promise<void> {
  const scene = JSON.parse(text("scene")) as Scene;
  document.title = scene.title;
  const data = await dataOf(scene), loading: Loading[] = [];
  const archives = await archivesOf(scene, data, loading);
  const renderer = new Renderer(document.getElementById("view") as HTMLCanvasElement, scene, data, archives);
  renderer.loading = loading.length > 0;
  renderer.failed = fail;
  renderer.lacking = (why) => { document.getElementById("status")!.textContent = `This browser draws translucent lines opaque: ${why}.`; };
  renderer.drawnOnce = () => { document.body.dataset.state = "drawn"; };
  new ResizeObserver(() => renderer.change()).observe(renderer.canvas);
  const controls = new Controls(renderer, data);
  attachMouse(renderer, (x, y) => controls.pick(x, y));
  attachNotebook(renderer, controls);
  (window as unknown as { pvfiblets: unknown }).pvfiblets = renderer;
  if (!loading.length) return;
  try {
    await load(loading, renderer);
  } finally {
    renderer.loading = false;
    renderer.grow();
  }
}

// The served page, which has no scene of its own, gets its renderer from here (pvfiblets/web/client/browser_renderer.js).
(window as unknown as { pvfibletsPage: unknown }).pvfibletsPage = { Renderer, attachMouse, readArchive };
if (document.getElementById("scene")) start().catch(fail);
