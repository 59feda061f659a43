// SPDX-License-Identifier: MIT
// As cross_answers.c, by cdprep.wasm in node. Usage: node cross_answers.mjs MODULE_FOLDER A B POSES
import { readFile } from "node:fs/promises";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, fileA, fileB, poses] = process.argv.slice(2);
const { load, CdprepError } = await import(pathToFileURL(resolve(join(folder, "cdprep.mjs"))));
const cdprep = await load(await readFile(join(folder, "cdprep.wasm")));

function hashOf(pairs) {
  let hash = 2166136261;
  for (const number of pairs) hash = Math.imul(hash ^ number, 16777619);
  return (hash >>> 0).toString(16).padStart(8, "0");
}

/** As %.17g of C. */
function digits(number) {
  if (number === 0) return "0";
  const exponent = Number(number.toExponential(16).split("e")[1]);
  if (exponent < -4 || exponent >= 17) {
    const [head, tail] = number.toExponential(16).split("e");
    const sign = tail[0], size = tail.slice(1).padStart(2, "0");
    return `${head.replace(/\.?0+$/, "")}e${sign}${size}`;
  }
  const text = number.toFixed(16 - exponent);
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

async function opened(file) {
  try {
    return cdprep.open(await readFile(file), basename(file));
  } catch (error) {
    if (!(error instanceof CdprepError)) throw error;
    console.error(`cross_answers: ${error.message}`);
    process.exit(error.code);
  }
}

const a = await opened(fileA), b = await opened(fileB);
const lines = (await readFile(poses, "utf8")).trim().split("\n");
lines.forEach((line, number) => {
  const p = line.trim().split(/\s+/).map(Number);
  const matrix = [p[0], p[3], p[6], 0, p[1], p[4], p[7], 0, p[2], p[5], p[8], 0, p[9], p[10], p[11], 1];
  const pairs = a.overlaps(b, matrix, { exact: true });
  const found = a.distance(b, matrix, { exact: true });
  if (a.collide(b, matrix, { exact: true }) !== pairs.length > 0) throw new Error("collide differs");
  console.log(`${number}: ${pairs.length / 2} pairs ${hashOf(pairs)}, distance ` +
    `${digits(found.lower)} to ${digits(found.upper)}`);
});
a.close();
b.close();
