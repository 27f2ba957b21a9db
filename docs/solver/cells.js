// What is typed into a cell: a number or a short expression of numbers and pi, with a unit or without.

const UNITS = {mm: 1e-3, cm: 1e-2, m: 1, deg: Math.PI / 180, "°": Math.PI / 180, rad: 1};
const OF_KIND = {length: ["mm", "cm", "m"], angle: ["deg", "°", "rad"]};

// The value in metres or radians; an error says what cannot be read.
function typedValue(text, kind) {
  const plain = text.trim().replace(/\u2212/g, "-").replace(/π/g, "pi").replace(/,/g, ".");
  const unit = plain.match(/(mm|cm|m|deg|°|rad)$/)?.[1];
  if (unit && !OF_KIND[kind].includes(unit)) throw new Error(`${unit} is no unit of ${kind === "length" ? "a length" : "an angle"}`);
  const expression = unit ? plain.slice(0, -unit.length) : plain;
  const value = sum({text: expression, at: 0});
  if (!Number.isFinite(value)) throw new Error(`${text}: no finite number`);
  const own = !unit && kind === "angle" && /pi/.test(expression);  // pi/2 is an angle in radians
  const factor = unit ? UNITS[unit] : own ? 1 : 1 / SCALES[unitOf(kind)];
  if (Math.abs(value * factor) > 1e4) throw new Error(`${text}: too large`);
  return value * factor;
}

function next(input, signs) {
  while (input.text[input.at] === " ") input.at++;
  const sign = input.text[input.at];
  if (sign === undefined || !signs.includes(sign)) return "";
  input.at++;
  return sign;
}

function sum(input, inside = false) {
  let value = term(input);
  for (let sign; (sign = next(input, "+-"));) value += sign === "+" ? term(input) : -term(input);
  if (next(input, ")") ? !inside : inside || input.at < input.text.length) throw new Error(`${input.text}: not a number`);
  return value;
}

function term(input) {
  let value = factorOf(input);
  for (let sign; (sign = next(input, "*/"));) value = sign === "*" ? value * factorOf(input) : value / factorOf(input);
  return value;
}

function factorOf(input) {
  const sign = next(input, "+-");
  if (sign) return sign === "-" ? -factorOf(input) : factorOf(input);
  if (next(input, "(")) return sum(input, true);
  const found = input.text.slice(input.at).match(/^ *(pi|\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)/);
  if (!found) throw new Error(`${input.text || "nothing"}: not a number`);
  input.at += found[0].length;
  return found[1] === "pi" ? Math.PI : Number(found[1]);
}
