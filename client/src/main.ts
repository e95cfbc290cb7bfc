/** The page's start: what it is to show, its data, and the errors that stop it, each as one sentence on the page. */

import { fromBase64 } from "./engine";
import { Controls } from "./controls";
import { attachMouse } from "./mouse";
import { Renderer } from "./renderer";
import type { Scene } from "./scene";

const text = (id: string): string => document.getElementById(id)?.textContent ?? "";

async function dataOf(scene: Scene): Promise<Uint8Array[]> {
  return Promise.all(scene.data.map(async (said, i) => {
    if (said.file === undefined) return fromBase64(text(`data-${i}`).trim());
    const answer = await fetch(said.file);
    if (!answer.ok) throw new Error(`${said.file} cannot be read (${answer.status}); it must lie beside this page.`);
    return new Uint8Array(await answer.arrayBuffer());
  }));
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
  const data = await dataOf(scene);
  const renderer = new Renderer(document.getElementById("view") as HTMLCanvasElement, scene, data);
  renderer.failed = fail;
  renderer.drawnOnce = () => { document.body.dataset.state = "drawn"; };
  new ResizeObserver(() => renderer.change()).observe(renderer.canvas);
  const controls = new Controls(renderer, data);
  attachMouse(renderer, (x, y) => controls.pick(x, y));
  (window as unknown as { pvfiblets: unknown }).pvfiblets = renderer;
}

start().catch(fail);
