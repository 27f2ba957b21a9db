"use strict";
// Kinematics of the arm: 4 x 4 matrices as 16 numbers by rows, metres and radians.

const arm = JSON.parse(document.getElementById("arm").textContent);

const I4 = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function mul(A, B) {
  const C = new Array(16);
  for (let i = 0; i < 4; i++)
    for (let j = 0; j < 4; j++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += A[4 * i + k] * B[4 * k + j];
      C[4 * i + j] = sum;
    }
  return C;
}

const origin = T => [T[3], T[7], T[11]];
const column = (T, k) => [T[k], T[4 + k], T[8 + k]];
const add = (p, d, s = 1) => p.map((v, k) => v + s * d[k]);
const distance = (p, q) => Math.hypot(...add(p, q, -1));

// The four DH motions, each a matrix.
const MOTION = {
  theta: t => [Math.cos(t), -Math.sin(t), 0, 0, Math.sin(t), Math.cos(t), 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  d: d => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, d, 0, 0, 0, 1],
  a: a => [1, 0, 0, a, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  alpha: t => [1, 0, 0, 0, 0, Math.cos(t), -Math.sin(t), 0, 0, Math.sin(t), Math.cos(t), 0, 0, 0, 0, 1],
};

// All joints of the chain, those that follow others too.
const chain = q => arm.gain.map((row, i) => row.reduce((sum, g, j) => sum + g * q[j], arm.offset[i]));

// Value of theta, d, a or alpha of a row with its joint at q.
function valueOf(row, key, q) {
  const moved = row.slides ? "d" : "theta";
  return row[key] + (key === moved ? row.sign * q : 0);
}

// Matrices of the motions of a row, in their order: standard theta, d, a, alpha; modified alpha, a, theta, d.
function motionsOf(row, q) {
  return row.motions.map(([key]) => key === "step" ? row.after : MOTION[key](valueOf(row, key, q)));
}

// DH frames 0 ... n in the base.
function frames(q) {
  const all = chain(q), out = [arm.first];
  arm.rows.forEach((row, i) => out.push(motionsOf(row, all[i]).reduce(mul, out[i])));
  return out;
}

// A vector of a frame in the base.
const turned = (T, v) => [0, 4, 8].map(k => T[k] * v[0] + T[k + 1] * v[1] + T[k + 2] * v[2]);

// T_base_bar of a bar of a parallelogram, the DH frames being at these places.
function barPose({turn, at, keep, point, shift}, placed) {
  const start = add(add(origin(placed[at]), turned(placed[at], point)), turned(placed[keep], shift)), T = [...placed[turn]];
  start.forEach((v, k) => T[4 * k + 3] = v);
  return T;
}

// T_base_tip.
const fk = q => mul(frames(q)[arm.rows.length], arm.tool);

// Roll, pitch, yaw of R = Rz(yaw) Ry(pitch) Rx(roll); roll is zero where only yaw -+ roll counts.
function rpy(T) {
  const flat = Math.hypot(T[0], T[4]), pitch = Math.atan2(-T[8], flat);
  if (flat < 1e-9) return [0, pitch, Math.atan2(-T[1], T[5])];
  return [Math.atan2(T[9], T[10]), pitch, Math.atan2(T[4], T[0])];
}

// Unit quaternion x, y, z, w with w not negative (Shepperd 1978).
function quaternion(T) {
  const t = T[0] + T[5] + T[10], d = [T[0], T[5], T[10], t], k = d.indexOf(Math.max(...d));
  const anti = [T[9] - T[6], T[2] - T[8], T[4] - T[1]];
  let q = [...anti, 1 + t];
  if (k < 3) q = [0, 1, 2].map(j => T[4 * k + j] + T[4 * j + k] + (j === k ? 1 - t : 0)).concat(anti[k]);
  const size = Math.hypot(...q) * (q[3] < 0 ? -1 : 1);
  return q.map(v => v / size);
}
