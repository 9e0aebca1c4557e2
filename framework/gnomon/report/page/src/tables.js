// Tables: the numbers under each picture, sortable.
import {costFigures, dynamicOf, errorFigures, numberText, valueText} from "./data.js";
import {element} from "./dom.js";

/** Columns are {title, get, text?, note?}; a click on a heading sorts by it, and again the other way. Nulls come last. */
export function sortableTable(caption, columns, rows, onRow) {
  let order = {column: null, rising: true};
  const body = element("tbody");
  const headings = columns.map((column) =>
    element("th", {scope: "col"},
            element("button", {type: "button", title: column.note ?? `sort by ${column.title}`, click: () => sortBy(column)},
                    column.title)));
  const fill = () => {
    const sorted = [...rows];
    if (order.column) sorted.sort((a, b) => compare(order.column.get(a), order.column.get(b), order.rising));
    body.replaceChildren(...sorted.map((row) => element("tr", {}, columns.map((column, i) => cell(column, row, i, onRow)))));
    columns.forEach((column, i) => headings[i].setAttribute(
      "aria-sort", column !== order.column ? "none" : order.rising ? "ascending" : "descending"));
  };
  const sortBy = (column) => {
    order = {column, rising: order.column === column ? !order.rising : true};
    fill();
  };
  fill();
  return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": caption},
                 element("table", {}, element("caption", {}, caption), element("thead", {}, element("tr", {}, headings)), body));
}

function compare(a, b, rising) {
  const absent = (value) => value === null || value === undefined;
  if (absent(a) || absent(b)) return absent(a) - absent(b);
  const sign = typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
  return rising ? sign : -sign;
}

function cell(column, row, index, onRow) {
  const value = column.get(row);
  const text = column.text ? column.text(row) : valueText(value);
  if (index > 0) return element("td", {class: typeof value === "number" ? "number" : null}, text);
  if (!onRow) return element("th", {scope: "row"}, text);
  return element("th", {scope: "row"}, element("button", {type: "button", class: "job", click: () => onRow(row)}, text));
}

function withInterval(value, interval) {
  if (value === null || value === undefined) return "–";
  return interval ? `${numberText(value)} [${numberText(interval[0])}, ${numberText(interval[1])}]` : numberText(value);
}

/** All jobs of a section with every figure that any of them has. */
export function jobsTable(jobs, onRow) {
  const has = (figure) => jobs.some((job) => figure.get(job) !== null && figure.get(job) !== undefined);
  const columns = [{title: "job", get: (job) => job.label}];
  for (const figure of errorFigures.filter(has)) {
    columns.push({title: figure.key === "rmse" ? "RMSE" : figure.key, note: figure.title, get: figure.get,
                  text: (job) => numberText(figure.get(job)) + (figure.spread?.(job) ? ` ± ${numberText(figure.spread(job), 2)}` : "")});
  }
  for (const figure of costFigures.filter(has)) {
    columns.push({title: figure.key, note: figure.title, get: figure.get,
                  text: (job) => withInterval(figure.get(job), figure.interval?.(job))});
  }
  return sortableTable("Every job with its figures; a heading sorts", columns, jobs, onRow);
}

/** Bars of the time of each pass, one row a job. */
export function passBars(jobs, onRow) {
  const timed = jobs.filter((job) => job.time?.passes?.length);
  if (timed.length === 0) return null;
  const longest = Math.max(...timed.map((job) => job.time.pass_sum_ms ?? 0));
  const rows = timed.map((job) => element("tr", {},
    element("th", {scope: "row"}, element("button", {type: "button", class: "job", click: () => onRow(job)}, job.label)),
    element("td", {class: "bars"}, job.time.passes.map((pass, i) => element("span", {
      class: `bar tone${i % 4}`, style: `width:${(100 * (pass.ms ?? 0) / longest).toFixed(3)}%`,
      title: `${pass.name}: ${numberText(pass.ms)} ms`}))),
    element("td", {}, job.time.passes.map((pass) => `${pass.name} ${numberText(pass.ms)}`).join(" · ")),
    element("td", {class: "number"}, numberText(job.time.pass_sum_ms)),
    element("td", {class: "number"}, numberText(dynamicOf(job)?.median_ms))));
  return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "passes"},
    element("table", {class: "passes"},
      element("caption", {}, "Passes of each job, timed one by one with a finish after each: their sum exceeds the whole"),
      element("thead", {}, element("tr", {}, ["job", "", "passes, ms", "sum", "whole"].map((t) => element("th", {scope: "col"}, t)))),
      element("tbody", {}, rows)));
}

const classNames = ["lit", "umbra", "penumbra", "band", "terminator"];

/** How much of the receivers is of which class; the same for all jobs of a section. */
export function classShares(jobs) {
  const classes = jobs.find((job) => job.error)?.error.classes;
  if (!classes) return null;
  const parts = classNames.slice(0, 3).map((name) => element("span", {
    class: `share ${name}`, style: `flex-grow:${classes[name]?.share ?? 0}`, title: `${name} ${percent(classes[name]?.share)}`}));
  return element("figure", {class: "shares"},
    element("div", {class: "sharebar", role: "img", "aria-label": classNames.map((n) => `${n} ${percent(classes[n]?.share)}`).join(", ")}, parts),
    element("figcaption", {}, `Receivers: ${classNames.map((name) => `${name} ${percent(classes[name]?.share)}`).join(" · ")}. `,
            "Band and terminator lie across the first three."));
}

function percent(share) {
  return share === null || share === undefined ? "–" : `${(100 * share).toFixed(1)} %`;
}

/** Which effects the scene calls for, and why. */
export function planTable(jobs) {
  const plan = jobs.find((job) => job.plan?.length)?.plan;
  if (!plan) return null;
  return sortableTable("The effect plan: what this scene and light call for", [
    {title: "effect", get: (entry) => entry.effect.replaceAll("_", " ")},
    {title: "runs", get: (entry) => (entry.on ? "yes" : "no")},
    {title: "because", get: (entry) => entry.reason},
  ], plan);
}

/** Jobs that did not come out, with the reason of each. */
export function troubleTable(jobs) {
  const troubled = jobs.filter((job) => job.status !== "ok" || job.reason);
  if (troubled.length === 0) return null;
  return sortableTable("Refused, failed, or with a remark", [
    {title: "job", get: (job) => job.label},
    {title: "status", get: (job) => job.status},
    {title: "reason", get: (job) => job.reason},
  ], troubled);
}
