/** A page in a frame of a notebook: it sends its idle camera and its picks to the kernel, and receives the kernel's. */

import type { CameraState } from "./camera";
import type { Controls, Pick } from "./controls";
import type { Renderer } from "./renderer";

interface Said {
  camera?: CameraState;
  picked?: Pick | null;
}

const isVector = (value: unknown): boolean => Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);

export function attachNotebook(renderer: Renderer, controls: Controls): void {
  const { parent } = window;
  if (parent === window) return;
  const tell = (said: Said | { ready: boolean }): void => parent.postMessage({ pvfiblets: said }, "*"), { state } = renderer.camera;
  let last = JSON.stringify(state);
  window.addEventListener("message", (event) => {
    const said = event.source === parent ? (event.data?.pvfiblets as Said | undefined) : undefined;
    if (!said) return;
    const { camera, picked } = said;
    if (
      camera &&
      isVector(camera.position) &&
      isVector(camera.focal_point) &&
      isVector(camera.up) &&
      camera.view_angle > 0 &&
      camera.parallel_scale > 0
    ) {
      Object.assign(state, camera);
      const now = JSON.stringify(state);
      if (now !== last) renderer.change();
      last = now;
    }
    if (picked !== undefined) controls.mark(picked);
  });
  renderer.finished = () => {
    const now = JSON.stringify(state);
    if (now !== last) tell({ camera: JSON.parse((last = now)) });
  };
  controls.told = (picked) => tell({ picked });
  tell({ ready: true });
}
