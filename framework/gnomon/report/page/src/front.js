// The Pareto front, and what it says in words.
import {numberText} from "./data.js";

/** Points that nothing beats in both figures, from the cheapest on: errors fall along it. */
export function paretoFront(points) {
  const front = [];
  for (const point of [...points].sort((a, b) => a.x - b.x || a.y - b.y)) {
    if (front.length === 0 || point.y < front.at(-1).y) front.push(point);
  }
  return front;
}

/** The front as steps: what error is to be had for a cost. */
export function stepsOf(front, limits) {
  if (front.length === 0) return [];
  const corners = [{x: front[0].x, y: limits.top}];
  front.forEach((point, i) => {
    corners.push({x: point.x, y: point.y});
    corners.push({x: i + 1 < front.length ? front[i + 1].x : limits.right, y: point.y});
  });
  return corners;
}

function overlap(a, b) {
  return a && b && a[0] <= b[1] && b[0] <= a[1];
}

/**
 * Walks the front from its cheapest point, halving the error each time: the cheapest job that has at most half, and what it
 * costs in terms of the one before. Stops where nothing on the front is that accurate.
 */
export function halvings(front) {
  const steps = [];
  let from = front[0];
  while (from) {
    const to = front.find((point) => point.y <= from.y / 2);
    if (!to) break;
    steps.push({from, to, factor: to.x / from.x, errorFactor: from.y / to.y, unsure: overlap(from.xInterval, to.xInterval)});
    from = to;
  }
  return steps;
}

/** Sentences on a section, the most telling first. */
export function sentencesOf(front, errorTitle, unit) {
  if (front.length === 0) return [];
  const name = (point) => point.job.label;
  const sentences = [];
  for (const {from, to, factor, errorFactor, unsure} of halvings(front)) {
    const halving = errorFactor < 2.5 ? "Halving the error" : `${numberText(errorFactor, 2)} times less error`;
    sentences.push(`${halving}, from ${numberText(from.y, 2)} to ${numberText(to.y, 2)}, costs ${numberText(factor, 2)} × ` +
                   `(${name(from)} → ${name(to)}).` + (unsure ? " Their costs' intervals overlap: this may be chance." : ""));
  }
  const best = front.at(-1);
  sentences.push(`The most accurate is ${name(best)}: ${errorTitle} ${numberText(best.y, 2)} for ` +
                 `${numberText(best.x)} ${unit}.`);
  return sentences;
}
