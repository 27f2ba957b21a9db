// The solid arm and the floor, in WebGL; without it the page shows the frames alone.

const bodies = document.getElementById("bodies");
const gl = bodies.getContext("webgl2", {antialias: true, preserveDrawingBuffer: true});

const VERTEX = `#version 300 es
in vec3 place, normal;
uniform mat4 clip, pose;
out vec3 facing;
void main() {
  facing = mat3(pose) * normal;
  gl_Position = clip * pose * vec4(place, 1.0);
}`;

// Sky, a sun over the left shoulder of the eye, and a rim that keeps edges dark.
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 facing;
uniform vec3 colour, right, up, near;
uniform float opacity, flat_;
out vec4 shown;
void main() {
  vec3 n = normalize(facing);
  float sun = max(dot(n, normalize(near + 0.6 * up - 0.5 * right)), 0.0);
  float light = 0.42 + 0.16 * n.z + 0.52 * sun;
  shown = vec4(colour * mix(light, 1.0, flat_) * opacity, opacity);
}`;

let program, at;

function shader(kind, text) {
  const made = gl.createShader(kind);
  gl.shaderSource(made, text);
  gl.compileShader(made);
  return made;
}

function unpacked(text, Kind) {
  return new Kind(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
}

// Normals of the vertices: the sum of those of the faces around; sharp edges have own vertices.
function normals(vertices, faces) {
  const sum = new Float32Array(vertices.length), p = k => vertices.subarray(3 * k, 3 * k + 3);
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [p(faces[f]), p(faces[f + 1]), p(faces[f + 2])];
    const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]], v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (let k = 0; k < 3; k++)
      for (let j = 0; j < 3; j++) sum[3 * faces[f + k] + j] += n[j];
  }
  return sum;
}

function buffer(kind, values) {
  const made = gl.createBuffer();
  gl.bindBuffer(kind, made);
  gl.bufferData(kind, values, gl.STATIC_DRAW);
}

// Vertices, normals and indices on the graphics card.
function shape(vertices, normal, indices) {
  const vao = gl.createVertexArray();
  gl.bindVertexArray(vao);
  [["place", vertices], ["normal", normal]].forEach(([name, values]) => {
    buffer(gl.ARRAY_BUFFER, values);
    const where = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(where);
    gl.vertexAttribPointer(where, 3, gl.FLOAT, false, 0, 0);
  });
  buffer(gl.ELEMENT_ARRAY_BUFFER, indices);
  return {vao, count: indices.length};
}

// Lines of the floor, at some height under the arm.
function floor(height) {
  const cell = 10 ** Math.floor(Math.log10(arm.size / 2)), half = 10, points = [];
  for (let k = -half; k <= half; k++)
    for (const [x0, y0, x1, y1] of [[k, -half, k, half], [-half, k, half, k]])
      points.push(x0 * cell, y0 * cell, height, x1 * cell, y1 * cell, height);
  const vertices = new Float32Array(points);
  return shape(vertices, vertices.map((_, k) => k % 3 === 2 ? 1 : 0), Uint32Array.from({length: points.length / 3}, (_, k) => k));
}

function prepare() {
  program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, VERTEX));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, FRAGMENT));
  gl.linkProgram(program);
  gl.useProgram(program);
  at = name => gl.getUniformLocation(program, name);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  let lowest = 0;  // of the base
  for (const node of arm.nodes)
    for (const surface of node.surfaces) {
      const [vertices, faces] = [unpacked(surface.vertices, Float32Array), unpacked(surface.faces, Uint32Array)];
      surface.shape = shape(vertices, normals(vertices, faces), faces);
      for (let k = 2; node === arm.nodes[0] && k < vertices.length; k += 3) lowest = Math.min(lowest, vertices[k]);
    }
  arm.floor = floor(lowest);
}

function drawShape({vao, count}, kind, colour, opacity, pose, unlit = 0) {
  gl.uniformMatrix4fv(at("pose"), true, pose);
  gl.uniform3fv(at("colour"), colour);
  gl.uniform1f(at("opacity"), opacity);
  gl.uniform1f(at("flat_"), unlit);
  gl.bindVertexArray(vao);
  gl.drawElements(kind, count, gl.UNSIGNED_INT, 0);
}

const poseOf = (node, i, placed) => node.bar ? barPose(node.bar, placed) : node.fixed ? mul(placed[i], node.fixed) : I4;

// Draw the arm with its DH frames at these places, solid or to be seen through.
function drawBodies(placed, opacity) {
  if (!gl) return;
  gl.viewport(0, 0, bodies.width, bodies.height);
  gl.clearColor(1, 1, 1, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.uniformMatrix4fv(at("clip"), false, clip());
  ["right", "up", "near"].forEach((name, k) => gl.uniform3fv(at(name), view()[k]));
  drawShape(arm.floor, gl.LINES, [0.9, 0.91, 0.93], 1, I4, 1);
  const parts = arm.nodes.flatMap((node, i) => node.surfaces.map(s => [s, poseOf(node, i, placed)]));
  const paint = () => parts.forEach(([s, pose]) => drawShape(s.shape, gl.TRIANGLES, s.colour.map(v => v / 255), opacity, pose));
  if (opacity < 1) {  // depths first, so that of each pixel the nearest surface alone is seen
    gl.colorMask(false, false, false, false);
    paint();
    gl.colorMask(true, true, true, true);
    gl.depthFunc(gl.LEQUAL);
  }
  paint();
  gl.depthFunc(gl.LESS);
}

if (gl) prepare();
