// Accuracy against cost: both logarithmic, intervals both ways, the front as steps.
import * as Plot from "@observablehq/plot";
import {numberText, pointsOf, valueText} from "./data.js";
import {element} from "./dom.js";
import {paretoFront, stepsOf} from "./front.js";
import {sortableTable} from "./tables.js";

// Okabe and Ito's colours, which are told apart by every kind of eye; shapes say the same again.
const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#9a6b00"];
const symbols = ["circle", "square", "triangle", "diamond", "star", "cross", "wye", "asterisk"];

/** The chart with its table; `onJob` is called when a point is chosen. */
export function accuracyChart(jobs, error, cost, width, onJob) {
  const {points, absent} = pointsOf(jobs, error, cost);
  const title = `${error.title} against ${cost.title}`;
  const chart = points.length > 0 ? plotOf(points, jobs, error, cost, width, title, onJob)
                                  : element("p", {class: "note"}, "Nothing to draw: no job has both figures.");
  return element("figure", {class: "chart", "data-cost": cost.key},
    element("h3", {}, title),
    chart,
    absent.length > 0 && points.length > 0
      ? element("p", {class: "note"}, "Not drawn: ", absent.map(({job, reason}) => `${job.label} (${reason})`).join("; "), ".")
      : null,
    element("details", {}, element("summary", {}, "the same in numbers"), tableOf(points, error, cost, onJob)));
}

function plotOf(points, jobs, error, cost, width, title, onJob) {
  const front = paretoFront(points);
  const values = (get) => points.flatMap(get).filter((v) => v > 0);
  const span = (list) => [Math.min(...list) / 1.25, Math.max(...list) * 1.25];
  const xs = span(values((p) => [p.x, ...(p.xInterval ?? [])]));
  const ys = span(values((p) => [p.y, ...(p.yInterval ?? [])]));
  const techniques = [...new Set(jobs.map((job) => job.technique))];
  const noise = error.floor ? Math.max(...points.map((p) => p.job.error?.noise_floor ?? 0)) : 0;
  const chart = Plot.plot({
    width, height: Math.max(320, Math.min(460, width * 0.62)),
    marginLeft: 58, marginBottom: 46, marginTop: 18, marginRight: 24,
    style: {background: "transparent", color: "inherit", fontSize: "12px", overflow: "visible"},
    ariaLabel: title,
    x: {type: "log", domain: xs, label: `${cost.title} →`, labelArrow: "none", grid: true, ticks: width < 500 ? 4 : 8, tickFormat: tickText},
    y: {type: "log", domain: ys, label: `↑ ${error.title}`, labelArrow: "none", grid: true, ticks: 6, tickFormat: tickText},
    color: {domain: techniques, range: techniques.map((_, i) => colours[i % colours.length])},
    symbol: {domain: techniques, range: techniques.map((_, i) => symbols[i % symbols.length])},
    marks: [
      noise > ys[0] ? Plot.ruleY([noise], {strokeDasharray: "2 4", strokeOpacity: 0.7}) : null,
      Plot.ruleY(points.filter((p) => p.xInterval), {y: "y", x1: (p) => p.xInterval[0], x2: (p) => p.xInterval[1], strokeOpacity: 0.5}),
      Plot.ruleX(points.filter((p) => p.yInterval), {x: "x", y1: (p) => p.yInterval[0], y2: (p) => p.yInterval[1], strokeOpacity: 0.5}),
      Plot.dot(points, {x: "x", y: "y", stroke: (p) => p.job.technique, fill: (p) => p.job.technique, fillOpacity: 0.25,
                        symbol: (p) => p.job.technique, r: 5, className: "points", ariaLabel: (p) => describe(p, error, cost),
                        title: (p) => tipOf(p, error, cost), tip: {maxRadius: 30, fill: "var(--paper)", stroke: "var(--line)"}}),
      Plot.line(stepsOf(front, {top: ys[1], right: xs[1]}), {x: "x", y: "y", stroke: "currentColor", strokeWidth: 1.2, className: "front"}),
      ...["start", "end"].map((anchor) => Plot.text(namesOf(front, xs, ys, width).filter((name) => name.anchor === anchor), {
        x: "x", y: "y", text: "text", dx: anchor === "start" ? 8 : -8, dy: -10, textAnchor: anchor, fill: "currentColor",
        stroke: "var(--paper)", strokeWidth: 4, className: "names"})),
    ],
  });
  makeChoosable(chart, points, error, cost, onJob);
  const legend = element("p", {class: "legend"}, techniques.map((name, i) => element("span", {}, mark(i), name)));
  return element("div", {}, legend, chart);
}

/** Names of the front's points that do not run into one another, the cheapest first; those near the right end lie left. */
function namesOf(front, xs, ys, width) {
  const letter = 6.4;
  const place = (value, [low, high], extent) => Math.log(value / low) / Math.log(high / low) * extent;
  const boxes = [];
  return front.flatMap((point) => {
    const text = point.job.label;
    const x = place(point.x, xs, width - 82);
    const y = place(point.y, ys, 340);
    const anchor = x + letter * text.length > width - 82 ? "end" : "start";
    const box = {left: anchor === "start" ? x : x - letter * text.length, right: anchor === "start" ? x + letter * text.length : x, y};
    if (boxes.some((b) => Math.abs(b.y - y) < 15 && b.left < box.right && box.left < b.right)) return [];
    boxes.push(box);
    return [{x: point.x, y: point.y, text, anchor}];
  });
}

/** Points are buttons: by mouse, by Enter and by space. */
function makeChoosable(chart, points, error, cost, onJob) {
  chart.querySelectorAll("g.points > path, g.points > circle").forEach((dot, i) => {
    const point = points[i];
    dot.setAttribute("tabindex", "0");
    dot.setAttribute("role", "button");
    dot.setAttribute("data-job", point.job.job);
    dot.addEventListener("click", () => onJob(point.job));
    dot.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      onJob(point.job);
    });
  });
  // The tip covers what it is about: a click on the chart is for the point that it tells of.
  chart.addEventListener("click", (event) => {
    const point = chart.value?.job ? chart.value : null;
    if (point && !event.target.closest("[data-job]")) onJob(point.job);
  });
}

function mark(i) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "-7 -7 14 14");
  svg.setAttribute("width", "14");
  svg.setAttribute("height", "14");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", symbolPath(symbols[i % symbols.length]));
  path.setAttribute("fill", colours[i % colours.length]);
  path.setAttribute("fill-opacity", "0.25");
  path.setAttribute("stroke", colours[i % colours.length]);
  path.setAttribute("stroke-width", "1.5");
  svg.append(path);
  return svg;
}

/** The outlines that the chart draws its points with. */
function symbolPath(name) {
  const drawn = Plot.plot({symbol: {domain: [name], range: [name]}, axis: null, width: 30, height: 30,
                           marks: [Plot.dot([name], {x: () => 0, y: () => 0, symbol: (d) => d, r: 4.5})]});
  return drawn.querySelector("path")?.getAttribute("d") ?? "M4.5,0A4.5,4.5,0,1,1,-4.5,0A4.5,4.5,0,1,1,4.5,0";
}

function tickText(value) {
  const digit = value / 10 ** Math.floor(Math.log10(value) + 1e-9);
  if (![1, 2, 5].some((d) => Math.abs(digit - d) < 1e-6)) return "";
  if (value >= 1e9) return `${numberText(value / 1e9)} G`;
  if (value >= 1e6) return `${numberText(value / 1e6)} M`;
  if (value >= 1e4) return `${numberText(value / 1e3)} k`;
  return numberText(value);
}

function describe(point, error, cost) {
  return `${point.job.label}: ${error.title} ${numberText(point.y)}, ${cost.title} ${numberText(point.x)}`;
}

function tipOf(point, error, cost) {
  const interval = point.xInterval ? ` [${numberText(point.xInterval[0])}, ${numberText(point.xInterval[1])}]` : "";
  const own = Object.entries(point.job.parameters ?? {}).map(([name, value]) => `${name} ${valueText(value)}`);
  return [point.job.label, `${error.title} ${numberText(point.y)}`, `${cost.title} ${numberText(point.x)}${interval}`, "", ...own].join("\n");
}

function tableOf(points, error, cost, onJob) {
  const front = new Set(paretoFront(points));
  const interval = (values) => (values ? `${numberText(values[0])} to ${numberText(values[1])}` : "–");
  return sortableTable(`${error.title} against ${cost.title}`, [
    {title: "job", get: (p) => p.job.label},
    {title: error.title, get: (p) => p.y},
    {title: "± 1 s.e.", get: (p) => p.yInterval?.[0], text: (p) => interval(p.yInterval)},
    {title: cost.title, get: (p) => p.x},
    {title: "95 %", get: (p) => p.xInterval?.[0], text: (p) => interval(p.xInterval)},
    {title: "on the front", get: (p) => (front.has(p) ? "yes" : "no")},
  ], points, (p) => onJob(p.job));
}
