/** Mouse, touch and keys: VTK's trackball. */

import type { Renderer } from "./renderer";

export type Picked = (x: number, y: number) => void;

export function attachMouse(renderer: Renderer, picked: Picked = () => undefined): void {
  const { canvas, camera } = renderer, down = new Map<number, { x: number; y: number }>();
  let far = 0, button = 0;

  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus();
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    far = 0;
    button = event.button;
    event.preventDefault();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  const end = (event: PointerEvent): void => {
    if (!down.delete(event.pointerId)) return;
    if (event.type === "pointerup" && far < 4 && button === 0 && !down.size) picked(event.offsetX, event.offsetY);
    else renderer.change();
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("pointermove", (event) => {
    const last = down.get(event.pointerId);
    if (!last) return;
    const dx = event.offsetX - last.x, dy = event.offsetY - last.y, width = canvas.clientWidth, height = canvas.clientHeight;
    far += Math.abs(dx) + Math.abs(dy);
    if (down.size === 2) {
      const other = [...down.entries()].find(([id]) => id !== event.pointerId)![1];
      const before = [last.x - other.x, last.y - other.y], now = [event.offsetX - other.x, event.offsetY - other.y];
      camera.dolly(Math.hypot(now[0], now[1]) / Math.max(1, Math.hypot(before[0], before[1])));
      camera.roll(((Math.atan2(now[1], now[0]) - Math.atan2(before[1], before[0])) * 180) / Math.PI);
      camera.pan(dx / 2 / height, -dy / 2 / height);
    } else if (button === 1 || event.shiftKey) camera.pan(dx / height, -dy / height);
    else if (button === 2) camera.dolly(Math.pow(1.1, (-2 * 10 * 0.2 * dy) / (height / 2) * 5));
    else if (event.ctrlKey) camera.roll((180 * dx) / width);
    else camera.rotate(dx / width, -dy / height);
    last.x = event.offsetX;
    last.y = event.offsetY;
    renderer.change(true);
  });
  canvas.addEventListener("wheel", (event) => {
    camera.dolly(Math.pow(1.1, Math.max(-3, Math.min(3, -event.deltaY / 50))));
    renderer.change(true);
    event.preventDefault();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const step = 0.04, keys: Record<string, () => void> = {
      ArrowLeft: () => (event.shiftKey ? camera.pan(-step, 0) : camera.rotate(-step, 0)),
      ArrowRight: () => (event.shiftKey ? camera.pan(step, 0) : camera.rotate(step, 0)),
      ArrowUp: () => (event.shiftKey ? camera.pan(0, step) : camera.rotate(0, step)),
      ArrowDown: () => (event.shiftKey ? camera.pan(0, -step) : camera.rotate(0, -step)),
      "+": () => camera.dolly(1.1),
      "=": () => camera.dolly(1.1),
      "-": () => camera.dolly(1 / 1.1),
      Enter: () => picked(canvas.clientWidth / 2, canvas.clientHeight / 2),
    };
    if (event.altKey || event.metaKey || !keys[event.key]) return;
    keys[event.key]();
    renderer.change(true);
    event.preventDefault();
  });
}
