// The page: a section for each scene and light.
import {accuracyChart} from "./charts.js";
import {comparer} from "./comparer.js";
import {costFigures, errorFigures, numberText, pointsOf, readPage, sectionsOf} from "./data.js";
import {choice, element} from "./dom.js";
import {paretoFront, sentencesOf} from "./front.js";
import {classShares, jobsTable, passBars, planTable, troubleTable} from "./tables.js";

const page = readPage(document);
const sections = sectionsOf(page.records);

function distinct(get) {
  return [...new Set(page.records.map(get).filter((v) => v !== null && v !== undefined && v !== ""))];
}

function head() {
  const trouble = page.records.filter((r) => r.status !== "ok");
  const facts = [
    ["jobs", `${page.records.length}` + (trouble.length > 0 ? `, of which ${trouble.length} not ok` : "")],
    ["renderer", distinct((r) => r.machine?.renderer).join("; ")],
    ["processor", distinct((r) => r.machine?.cpu).join("; ")],
    ["timer", distinct((r) => r.time?.timer).join("; ")],
    ["processes timed", distinct((r) => r.time?.repeats).join("; ")],
  ].filter(([, value]) => value !== "");
  return element("header", {},
    element("h1", {}, page.title),
    element("p", {class: "lead"}, "What each technique's accuracy costs, measured against a ray-traced reference."),
    element("dl", {class: "facts"}, facts.map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value)))),
    distinct((r) => r.time?.timer).includes("cpu")
      ? element("p", {class: "note"}, "Times are of a software renderer, by the processor's time. They rank techniques here; of a GPU the work says more.") : null,
    page.warnings.map((warning) => element("p", {class: "warning"}, warning)),
    sections.length > 1
      ? element("nav", {"aria-label": "scenes"}, sections.map((s, i) => element("a", {href: `#section-${i}`}, titleOf(s)))) : null);
}

function titleOf(section) {
  const several = sections.some((s) => s.scene === section.scene && s.light !== section.light);
  const configs = distinct((r) => r.config).length > 1;
  return section.scene + (several ? `, light ${section.light}` : "") + (configs ? ` (${section.config})` : "");
}

function sectionOf(section, index) {
  const pictures = comparer(page, section);
  const onJob = (job) => pictures.show(job);
  let error = errorFigures[0];
  let work = costFigures.find((f) => f.key === "reads");
  let time = costFigures.find((f) => f.key === "ms");
  const has = (figure) => section.jobs.some((job) => figure.get(job) > 0);
  const charts = element("div", {class: "charts"});
  const words = element("ul", {class: "words"});
  const controls = element("div", {class: "controls"});
  const draw = () => {
    const {points} = pointsOf(section.jobs, error, time);
    words.replaceChildren(...sentencesOf(paretoFront(points), error.title, time.unit).map((text) => element("li", {}, text)));
    const available = charts.clientWidth || Math.min(1160, document.documentElement.clientWidth - 32);
    const width = available > 900 ? Math.floor((available - 40) / 2) : available;
    charts.replaceChildren(...[time, work].map((cost) => accuracyChart(section.jobs, error, cost, width, onJob)));
    controls.replaceChildren(
      choice("accuracy by", errorFigures.filter(has), error, (f) => { error = f; draw(); }),
      choice("time as", costFigures.filter((f) => f.time && has(f)), time, (f) => { time = f; draw(); }),
      choice("work as", costFigures.filter((f) => !f.time && has(f)), work, (f) => { work = f; draw(); }));
  };
  const root = element("section", {id: `section-${index}`, "aria-label": titleOf(section)},
    element("h2", {}, titleOf(section)), words, controls, charts,
    element("h3", {}, "Pictures"), pictures.root,
    element("h3", {}, "All jobs"), jobsTable(section.jobs, onJob),
    passBars(section.jobs, onJob), classShares(section.jobs), referenceNote(section), troubleTable(section.jobs), planTable(section.jobs));
  return {root, draw};
}

/** What the reference is worth, what it took, and what even the right visibility gets wrong. */
function referenceNote(section) {
  const sentences = [];
  const floors = section.jobs.map((job) => job.error?.noise_floor).filter((v) => v > 0);
  if (floors.length > 0) sentences.push(`Noise of the reference: ${numberText(Math.max(...floors))}. Nothing below it is told apart.`);
  const {rays, rays_saved: saved, cosine_floor: cosineFloor} = section.jobs.find((job) => job.reference)?.reference ?? {};
  if (rays > 0) sentences.push(`It took ${numberText(rays)} rays${saved > 0 ? ` and could do without ${numberText(saved)} more` : ""}.`);
  if (cosineFloor > 0) {
    sentences.push(`A picture shaded with its visibility and the light's centre is off by ${numberText(cosineFloor)} from one with the ` +
      "exact integral over the source: no technique of visibility gets below that.");
  }
  return sentences.length > 0 ? element("p", {class: "note"}, sentences.join(" ")) : null;
}

const made = sections.map(sectionOf);
document.body.append(element("main", {}, head(),
  made.length === 0 ? element("p", {class: "warning"}, "There are no results in this folder.") : null, made.map((s) => s.root),
  element("footer", {}, "Written by gnomon report. What each number is, and how to distrust it: docs/measuring.md.")));
for (const section of made) section.draw();
let width = document.documentElement.clientWidth;
addEventListener("resize", () => {
  if (document.documentElement.clientWidth === width) return;
  width = document.documentElement.clientWidth;
  for (const section of made) section.draw();
});
document.documentElement.dataset.ready = "yes";
