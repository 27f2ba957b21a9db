// Any six turning joints: which eliminations suit an arm, as dh2urdf.ik.families.general_6r finds it.

const six = page.general;  // numbers and places in the record, from the package

// A field of the record.
function part(arm, name) {
  const {offset, size, whole} = six.fields[name];
  return whole ? new BigInt64Array(memory, arm.byteOffset + offset, size) : new Float64Array(memory, arm.byteOffset + offset, size);
}

// The same chain with each joint's origin slid along its axis, so that the links are short:
// the least squares of t_i - a_i e3 + a_(i+1) R_i e3.
function shortLinks(links) {
  const square = Array.from({length: 6}, () => new Array(6).fill(0)), right = new Array(6).fill(0);
  for (let i = 1; i < 6; i++) {
    const t = origin(links[i]), z = column(links[i], 2), rows = [0, 1, 2].map(k => [k === 2 ? -1 : 0, z[k], -t[k]]);
    for (const [u, v, b] of rows) {
      square[i - 1][i - 1] += u * u; square[i - 1][i] += u * v; square[i][i - 1] += u * v; square[i][i] += v * v;
      right[i - 1] += u * b; right[i] += v * b;
    }
  }
  square.forEach((row, i) => { row[i] += 1e-9; });  // where axes are parallel any slide will do
  const slides = solved(square, right), short = links.map(link => [...link]);
  for (let i = 0; i < 6; i++) {
    short[i] = mul(short[i], shiftZ(slides[i]));
    short[i + 1] = product(turnZ(six.turn[i]), shiftZ(-slides[i]), short[i + 1]);
  }
  return short;
}

// Gauss's elimination of a positive definite matrix.
function solved(A, b) {
  const rows = A.map((row, i) => [...row, b[i]]), n = b.length;
  rows.forEach((row, i) => rows.slice(i + 1).forEach(next => {
    const f = next[i] / row[i];
    for (let k = i; k <= n; k++) next[k] -= f * row[k];
  }));
  const x = new Array(n).fill(0);
  for (let i = n - 1; i >= 0; i--) x[i] = (rows[i][n] - rows[i].reduce((sum, v, k) => k > i && k < n ? sum + v * x[k] : sum, 0)) / rows[i][i];
  return x;
}

function recordOf(links) {
  const arm = floats(six.size / FLOATS), short = shortLinks(links), put = (name, values) => part(arm, name).set(values.flat());
  const lengths = short.slice(1, 6).map(link => Math.hypot(...origin(link))), size = Math.max(...lengths) || 1;
  put("size", [size]);
  put("links", links.map(link => link.slice(0, 12)));
  put("ends", [inverse(short[0]), inverse(short[6])]);
  put("turns", [six.turn.map(Math.cos), six.turn.map(Math.sin), six.turn]);
  put("chain", short.slice(1, 6).map(link => link.slice(0, 12).map((v, k) => k % 4 === 3 ? v / size : v)));
  return arm;
}

function cut(arm, eliminations, out) {
  part(arm, "trials")[0] = BigInt(eliminations.length);
  eliminations.flat().forEach((v, k) => { part(arm, "choices")[k] = BigInt(v); });
  part(arm, "ready")[0] = 0n;
  kernels.solve_general_6r(0, arm, out.pose, out.q, out.residual, out.count, out.doubt);
}

// Numbers between -1 and 1, the same ones each time.
function random(seed) {
  let state_ = seed;
  return () => { state_ = (1664525 * state_ + 1013904223) % 4294967296; return state_ / 2147483648 - 1; };
}

// The record of an arm with the eliminations that find most on random poses, best first.
function planned(links, rows) {
  const arm = recordOf(links), next = random(1);
  const out = {...outputs(16, 6), pose: floats(16), doubt: integers(1)};
  const poses = Array.from({length: six.poses}, () => forward(links, rows, rows.map(() => Math.PI * next())));
  const trials = [0, 1].flatMap(way => [0, 1, 2, 3, 4, 5].map(shift => [shift, way]));
  const ranked = trials.map(elimination => {
    cut(arm, [elimination], out);
    let [found, digits] = [0, 0];
    for (const T of poses) {
      out.pose.set(T);
      kernels.solve_general_6r(1, arm, out.pose, out.q, out.residual, out.count, out.doubt);
      const [seeded, spans] = part(arm, "first");
      found += Number(out.count[0]) / poses.length;
      digits -= Math.min(Math.log10(Math.max(seeded, 1e-16)) + Math.min(spans, six.dearest), 0) / poses.length;
    }
    return {elimination, found, worth: found + digits * six.worth};
  }).sort((a, b) => b.worth - a.worth);
  const most = Math.max(...ranked.map(r => r.found));
  const kept = ranked.filter(r => r.found >= six.usable * most).slice(0, six.most);
  cut(arm, kept.map(r => r.elimination), out);
  return arm;
}
