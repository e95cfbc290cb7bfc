// Measured distances over a picture that the browser draws: lines, seen through whatever is before them, and their lengths
// beside their middles. pvfiblets/web/distance_label.py shows the same in the server's pictures.
(() => {
  "use strict";

  const SVG = "http://www.w3.org/2000/svg";
  const NEAREST = 1e-3; // of the farther end's depth: what is nearer to the eye, or behind it, is not drawn

  const times = (matrix, [x, y, z, w]) => [0, 1, 2, 3].map((i) => matrix[i] * x + matrix[i + 4] * y + matrix[i + 8] * z + matrix[i + 12] * w);
  const between = (a, b, share) => a.map((part, i) => part + share * (b[i] - part));

  const shape = (name, attributes) => {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  };

  // One distance of a scene as lines and text; nothing of one that is behind the eye.
  const drawn = ({ from, to, text }, seen, at) => {
    const a = seen(from), b = seen(to), least = NEAREST * Math.max(a[3], b[3]), middle = between(a, b, 0.5);
    if (!(least > 0)) return [];
    const [[x1, y1], [x2, y2]] = [[a, b], [b, a]].map(
      ([end, other]) => at(end[3] < least ? between(end, other, (least - end[3]) / (other[3] - end[3])) : end),
    );
    const line = shape("line", { x1, y1, x2, y2 });
    if (middle[3] < least) return [line];
    const [x, y] = at(middle), label = shape("text", { x: x - 3, y });
    label.textContent = text;
    return [line, label];
  };

  window.pvfibletsDistances = ({ camera, canvas, scene, width, height }) => {
    const over = document.querySelector("#pv-there-distances");
    if (!scene.distances.length) return over.replaceChildren();
    const view = camera.view(), projection = camera.projection(width / height, scene.bounds);
    const seen = (place) => times(projection, times(view, [...place, 1]));
    const at = ([x, y, , w]) => [((1 + x / w) / 2) * canvas.clientWidth, ((1 - y / w) / 2) * canvas.clientHeight];
    const whole = shape("svg", {});
    whole.append(...scene.distances.flatMap((one) => drawn(one, seen, at)));
    over.replaceChildren(whole);
  };
})();
