// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";

const study = JSON.parse(document.getElementById("study").textContent);
const tip = document.getElementById("tip");
let kept = null;

const digits = (value) => Number(value.toPrecision(3)).toString();

function in_time(seconds) {
  for (const [unit, size] of [["ns", 1e-9], ["us", 1e-6], ["ms", 1e-3]]) {
    if (seconds < size * 1000) return `${digits(seconds / size)} ${unit}`;
  }
  return `${digits(seconds)} s`;
}

const per_cent = (share) => share === 0 ? "0" : `${digits(100 * share)} %`;

function in_bytes(bytes) {
  if (bytes < 1e4) return `${bytes} B`;
  return bytes < 1e7 ? `${digits(bytes / 1e3)} kB` : `${digits(bytes / 1e6)} MB`;
}

/** A share with its 95 % band, where that is wider than a point. */
function in_band(band) {
  const value = band.value.toFixed(5);
  return band.low < band.high ? `${value} (${band.low.toFixed(5)} to ${band.high.toFixed(5)})`
    : value;
}

/** How poses of a rung's stratum went: "deep: 4.1 us, 0 of 50 missed". */
function stratum_line(name, stratum) {
  const parts = [];
  if (stratum.median_s > 0) parts.push(in_time(stratum.median_s));
  if (stratum.misses && stratum.misses.of) {
    parts.push(`${stratum.misses.count} of ${stratum.misses.of} missed`);
  }
  if (stratum.false_hits && stratum.false_hits.of) {
    parts.push(`${stratum.false_hits.count} of ${stratum.false_hits.of} false hits`);
  }
  return parts.length ? [name, parts.join(", ")] : null;
}

/** Names and values to show of a rung. */
function facts_of(ladder, rung) {
  const time = rung.time;
  const facts = [
    ["promise", rung.promise],
    ["time", `${in_time(time.median_s)} (95 %: ${in_time(time.low_s)} to ${in_time(time.high_s)}), `
      + `p95 ${in_time(time.p95_s)}, p99.9 ${in_time(time.p999_s)}`],
    ["measured", `${time.cases} cases, ${time.rounds} rounds, spread ${in_time(time.spread_s)}`]];
  if (rung.build_s !== undefined) facts.push(["build", in_time(rung.build_s)]);
  if (rung.bytes !== undefined) facts.push(["size", in_bytes(rung.bytes)]);
  if (rung.touched_bytes !== undefined) {
    facts.push(["reads", `${in_bytes(Math.round(rung.touched_bytes))} per query`]);
  }
  if (rung.error) {
    facts.push(["error", `${per_cent(rung.error.value)} (${per_cent(rung.error.low)} to `
      + `${per_cent(rung.error.high)})`]);
  }
  if (rung.outer !== undefined) facts.push(["outer error", `${per_cent(rung.outer)} of the diagonal`]);
  if (rung.pairs) {
    facts.push(["pairs", `recall ${in_band(rung.pairs.recall)}, `
      + `precision ${in_band(rung.pairs.precision)}`]);
  }
  if (rung.distance) {
    const holds = rung.distance.interval_holds;
    facts.push(["interval", `contains the exact distance in ${holds.count} of ${holds.of}`]);
  }
  if (rung.rigid) {
    const {misses, false_hits, undecided} = rung.rigid;
    facts.push(["proved at E3", `${misses.count} of ${misses.of} missed, ${false_hits.count} of `
      + `${false_hits.of} false hits; ${undecided} poses not proved`]);
  }
  for (const [name, stratum] of Object.entries(rung.strata || {})) {
    const line = stratum_line(name, stratum);
    if (line) facts.push(line);
  }
  return facts;
}

function worst_of(rung) {
  if (!rung.worst) return null;
  const pose = study.poses[rung.worst.pose];
  const place = pose.hit
    ? `${per_cent(pose.depth / study.diagonal)} of the diagonal deep`
    : `${per_cent(pose.gap[1] / study.diagonal)} of the diagonal apart`;
  return {text: `pose ${rung.worst.pose} (${pose.stratum}, ${place}): ${rung.worst.what}`,
          pose: pose.pose.join(" ")};
}

function add(parent, kind, text) {
  const element = document.createElement(kind);
  element.textContent = text;
  parent.append(element);
  return element;
}

function fill_tip(ladder, rung) {
  tip.replaceChildren();
  add(tip, "h4", `${ladder.name}: ${rung.name}`);
  add(tip, "p", rung.how + (rung.dominated ? ". Another rung is better." : "."));
  const list = add(tip, "dl", "");
  for (const [name, value] of facts_of(ladder, rung)) {
    add(list, "dt", name);
    add(list, "dd", value);
  }
  const worst = worst_of(rung);
  if (!worst) return;
  add(list, "dt", "worst");
  const place = add(list, "dd", worst.text);
  add(place, "br", "");
  add(place, "code", worst.pose);
}

/** Beside the mark, inside the window. */
function place_tip(mark) {
  const box = mark.getBoundingClientRect();
  const size = tip.getBoundingClientRect();
  const right = box.right + 14;
  const left = right + size.width < innerWidth ? right : Math.max(8, box.left - 14 - size.width);
  const top = Math.min(Math.max(8, box.top - 20), Math.max(8, innerHeight - size.height - 8));
  tip.style.left = `${left}px`;
  tip.style.top = `${top}px`;
}

function same_rung(mark) {
  const {ladder, rung} = mark.dataset;
  return document.querySelectorAll(`[data-ladder="${ladder}"][data-rung="${rung}"]`);
}

function unlight() {
  for (const lit of document.querySelectorAll(".lit")) lit.classList.remove("lit");
}

function show(mark) {
  unlight();
  for (const other of same_rung(mark)) other.classList.add("lit");
  const ladder = study.ladders[mark.dataset.ladder];
  fill_tip(ladder, ladder.rungs[mark.dataset.rung]);
  tip.hidden = false;
  place_tip(mark);
}

function hide() {
  unlight();
  tip.hidden = true;
  tip.classList.remove("kept");
  kept = null;
}

for (const mark of document.querySelectorAll("svg [data-rung], tbody [data-rung]")) {
  mark.addEventListener("mouseenter", () => { if (!kept) show(mark); });
  mark.addEventListener("mouseleave", () => { if (!kept) hide(); });
  mark.addEventListener("focus", () => { if (!kept) show(mark); });
  mark.addEventListener("blur", () => { if (!kept) hide(); });
  mark.addEventListener("click", (event) => {
    event.stopPropagation();
    show(mark);
    kept = mark;
    tip.classList.add("kept");
  });
}
document.addEventListener("click", (event) => { if (!tip.contains(event.target)) hide(); });
document.addEventListener("keydown", (event) => { if (event.key === "Escape") hide(); });
document.getElementById("view").setAttribute("aria-busy", "false");
