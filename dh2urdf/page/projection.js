// The eye: an orthographic projection, turned about the vertical and tilted.

const eye = {azimuth: -0.9, elevation: 0.42, scale: 1, target: [0, 0, 0]};
const main = document.querySelector("main");

// Axes of the picture in the base: to the right, up, and towards the eye.
function view() {
  const [ca, sa, ce, se] = [Math.cos(eye.azimuth), Math.sin(eye.azimuth), Math.cos(eye.elevation), Math.sin(eye.elevation)];
  return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
}

// Where a point of the base is in the picture [px], and how near to the eye it is [m].
function project(p) {
  const away = add(p, eye.target, -1), along = view().map(axis => axis[0] * away[0] + axis[1] * away[1] + axis[2] * away[2]);
  return [main.clientWidth / 2 + eye.scale * along[0], main.clientHeight / 2 - eye.scale * along[1], along[2]];
}

// The matrix from the base to the clip space of WebGL, by columns as it wants them.
function clip() {
  const [right, up, near] = view(), depth = 40 * arm.size;
  const rows = [[right, 2 * eye.scale / main.clientWidth], [up, 2 * eye.scale / main.clientHeight], [near, -1 / depth]];
  const M = rows.map(([axis, s]) => [...axis.map(v => s * v), -s * axis.reduce((sum, v, k) => sum + v * eye.target[k], 0)]);
  return [0, 1, 2, 3].flatMap(j => [M[0][j], M[1][j], M[2][j], j === 3 ? 1 : 0]);
}

// Put the whole arm into the picture as it stands.
function lookAtAll(q) {
  const points = [[0, 0, 0], ...frames(q).map((T, i) => add(origin(T), column(T, 2), arm.shifts[i])), origin(fk(q))];
  const low = [0, 1, 2].map(k => Math.min(...points.map(p => p[k])));
  const high = [0, 1, 2].map(k => Math.max(...points.map(p => p[k])));
  eye.target = low.map((v, k) => (v + high[k]) / 2);
  const span = Math.max(distance(low, high), 0.8 * arm.size) + 0.35 * arm.size;
  eye.scale = Math.min(main.clientWidth, main.clientHeight) / span;
}

// Turning, moving and coming nearer by mouse, pen or finger; two fingers pinch.
function followPointers(canvas, draw) {
  const held = new Map();
  canvas.onpointerdown = event => { held.set(event.pointerId, event); canvas.setPointerCapture(event.pointerId); };
  canvas.onpointerup = canvas.onpointercancel = event => held.delete(event.pointerId);
  canvas.onpointermove = event => {
    const last = held.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.clientX - last.clientX, event.clientY - last.clientY];
    const other = [...held.values()].find(e => e.pointerId !== event.pointerId);
    const apart = e => other && Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY);
    held.set(event.pointerId, event);
    if (other) eye.scale *= apart(event) / Math.max(apart(last), 1);
    else if (event.shiftKey || event.buttons > 1) shift(dx, dy);
    else {
      eye.azimuth -= 0.008 * dx;
      eye.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, eye.elevation + 0.008 * dy));
    }
    draw();
  };
  canvas.oncontextmenu = event => event.preventDefault();
  canvas.onwheel = event => { event.preventDefault(); eye.scale *= Math.exp(-0.0012 * event.deltaY); draw(); };
}

function shift(dx, dy) {
  const [right, up] = view();
  eye.target = add(add(eye.target, right, -dx / eye.scale), up, dy / eye.scale);
}
