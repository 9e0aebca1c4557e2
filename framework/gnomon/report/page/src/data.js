// The records and pictures that the page holds, and the names that things go by.

/** Everything that `gnomon report` put into the page. */
export function readPage(document) {
  return JSON.parse(document.getElementById("gnomon-data").textContent);
}

/** Jobs that can be compared: one scene, one light, one config. In the order of the records. */
export function sectionsOf(records) {
  const sections = new Map();
  for (const record of records) {
    const key = JSON.stringify([record.config, record.scene, record.light]);
    if (!sections.has(key)) {
      sections.set(key, {config: record.config, scene: record.scene, light: record.light, jobs: []});
    }
    sections.get(key).jobs.push(record);
  }
  for (const section of sections.values()) nameJobs(section.jobs);
  return [...sections.values()];
}

/** Gives each job a label: its technique, and those parameters in which jobs of that technique differ. */
function nameJobs(jobs) {
  for (const job of jobs) {
    const alike = jobs.filter((other) => other.technique === job.technique);
    const differing = Object.keys(job.parameters ?? {}).filter((name) =>
      alike.some((other) => JSON.stringify(other.parameters?.[name]) !== JSON.stringify(job.parameters[name])));
    job.differing = differing.map((name) => `${name} ${valueText(job.parameters[name])}`).join(", ");
    job.label = job.differing ? `${job.technique}, ${job.differing}` : job.technique;
  }
}

export function valueText(value) {
  if (value === null || value === undefined) return "–";
  if (Array.isArray(value)) return value.map(valueText).join(" × ");
  if (Number.isInteger(value)) return String(value);
  if (typeof value === "number") return numberText(value);
  return String(value);
}

/** Three digits, and thousands apart; null is a dash, never 0. */
export function numberText(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e12 || size < 1e-4) return value.toExponential(digits - 1);
  if (size >= 1000) return Math.round(value).toLocaleString("en").replaceAll(",", "\u202f");
  return Number(value.toPrecision(digits)).toString();
}

/** What may be an axis of accuracy: a figure, its standard error where it has one, and what it is. */
export const errorFigures = [
  {key: "rmse", title: "RMSE of visibility", get: (job) => job.error?.rmse, spread: (job) => job.error?.rmse_se, floor: true},
  {key: "band", title: "RMSE in the band of shadow edges", get: (job) => job.error?.rmse_band, floor: true},
  {key: "flip", title: "HDR-FLIP, mean", get: (job) => job.flip?.mean},
  {key: "acne", title: "acne", get: (job) => job.splits?.acne},
  {key: "leak", title: "leak", get: (job) => job.splits?.leak},
  {key: "detachment", title: "detachment, metres", get: (job) => job.splits?.detachment},
  {key: "penumbra", title: "penumbra, |log2| of widths", get: (job) => job.splits?.penumbra},
  {key: "offset", title: "offset, metres", get: (job) => job.splits?.offset},
  {key: "shimmer", title: "shimmer", get: (job) => job.splits?.shimmer},
];

/** What may be an axis of cost. `interval` is of 95 %. */
export const costFigures = [
  {key: "ms", title: "time, ms", unit: "ms", time: true, get: (job) => dynamicOf(job)?.median_ms,
   interval: (job) => dynamicOf(job)?.ci95_ms},
  {key: "ratio", title: "time, × baseline", unit: "×", time: true, get: (job) => dynamicOf(job)?.ratio,
   interval: (job) => dynamicOf(job)?.ratio_ci95},
  {key: "reads", title: "texels read", unit: "texels", get: (job) => job.work?.texel_reads},
  {key: "fragments", title: "fragments", unit: "fragments", get: (job) => job.work?.fragments},
  {key: "bytes", title: "bytes written", unit: "bytes", get: (job) => job.work?.bytes_written},
  {key: "rays", title: "rays", unit: "rays", get: (job) => job.work?.rays},
  {key: "memory", title: "memory, bytes", unit: "bytes", get: (job) => job.memory_bytes},
];

export function dynamicOf(job) {
  return job.time?.regimes?.dynamic;
}

/** Points of a chart, and the jobs that have none with the reason. Logarithms know neither null nor 0. */
export function pointsOf(jobs, error, cost) {
  const points = [];
  const absent = [];
  for (const job of jobs) {
    const y = error.get(job);
    const x = cost.get(job);
    if (y > 0 && x > 0) {
      points.push({job, x, y, xInterval: cost.interval?.(job) ?? null, yInterval: spreadOf(y, error.spread?.(job))});
    } else {
      absent.push({job, reason: reasonOfAbsence(job, error, cost, y, x)});
    }
  }
  return {points, absent};
}

/** One standard error each way; none reaches 0, which has no logarithm. */
function spreadOf(value, standardError) {
  if (!(standardError > 0)) return null;
  return [Math.max(value - standardError, value / 100), value + standardError];
}

function reasonOfAbsence(job, error, cost, y, x) {
  if (job.status !== "ok") return job.status;
  const parts = [];
  if (y === null || y === undefined) parts.push(`${error.title}: not measured`);
  else if (!(y > 0)) parts.push(`${error.title}: ${numberText(y)}`);
  if (x === null || x === undefined) parts.push(`${cost.title}: not measured`);
  else if (!(x > 0)) parts.push(`${cost.title}: ${numberText(x)}`);
  return parts.join("; ");
}
