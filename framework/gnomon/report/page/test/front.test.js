import assert from "node:assert/strict";
import {test} from "node:test";
import {numberText, pointsOf, sectionsOf, errorFigures, costFigures} from "../src/data.js";
import {halvings, paretoFront, sentencesOf, stepsOf} from "../src/front.js";

const point = (x, y, label = `${x}/${y}`, xInterval = null) => ({x, y, xInterval, job: {label}});

test("the front holds what nothing beats in both", () => {
  const points = [point(3, 2), point(1, 4), point(2, 5), point(4, 2), point(5, 1)];
  assert.deepEqual(paretoFront(points).map((p) => p.x), [1, 3, 5]);
});

test("of equal costs the more accurate one is on the front", () => {
  assert.deepEqual(paretoFront([point(1, 4), point(1, 3)]).map((p) => p.y), [3]);
});

test("steps go down at each point's cost", () => {
  assert.deepEqual(stepsOf([point(1, 4), point(3, 2)], {top: 9, right: 10}),
                   [{x: 1, y: 9}, {x: 1, y: 4}, {x: 3, y: 4}, {x: 3, y: 2}, {x: 10, y: 2}]);
  assert.deepEqual(stepsOf([], {top: 9, right: 10}), []);
});

test("halving takes the cheapest that has at most half", () => {
  const steps = halvings(paretoFront([point(1, 0.08), point(2, 0.05), point(3, 0.04), point(9, 0.01)]));
  assert.deepEqual(steps.map((s) => [s.from.x, s.to.x, s.factor]), [[1, 3, 3], [3, 9, 3]]);
});

test("words say the errors, the factor and whom", () => {
  const words = sentencesOf([point(10, 0.04, "pcf"), point(18, 0.02, "pcss")], "RMSE", "ms");
  assert.equal(words[0], "Halving the error, from 0.04 to 0.02, costs 1.8 × (pcf → pcss).");
  assert.equal(words[1], "The most accurate is pcss: RMSE 0.02 for 18 ms.");
});

test("words warn where costs cannot be told apart", () => {
  const words = sentencesOf([point(10, 0.04, "a", [8, 12]), point(11, 0.02, "b", [9, 13])], "RMSE", "ms");
  assert.match(words[0], /overlap/);
});

test("what was not measured is no point, and says so", () => {
  const jobs = [{status: "ok", error: {rmse: 0.1}, work: {texel_reads: 0}}, {status: "ok", error: {rmse: 0.1}, work: {}},
                {status: "refused"}, {status: "ok", error: {rmse: 0.1}, work: {texel_reads: 7}}];
  const reads = costFigures.find((f) => f.key === "reads");
  const {points, absent} = pointsOf(jobs, errorFigures[0], reads);
  assert.deepEqual(points.map((p) => p.x), [7]);
  assert.deepEqual(absent.map((a) => a.reason), ["texels read: 0", "texels read: not measured", "refused"]);
});

test("jobs are called by what they differ in", () => {
  const job = (technique, parameters) => ({config: "c", scene: "s", light: 0, technique, parameters});
  const [section] = sectionsOf([job("pcf", {taps: 3, size: 64}), job("pcf", {taps: 5, size: 64}), job("vsm", {size: 64})]);
  assert.deepEqual(section.jobs.map((j) => j.label), ["pcf, taps 3", "pcf, taps 5", "vsm"]);
});

test("numbers keep three digits, and null is no 0", () => {
  assert.equal(numberText(0.012345), "0.0123");
  assert.equal(numberText(1234567), "1\u202f234\u202f567");
  assert.equal(numberText(null), "–");
  assert.equal(numberText(0), "0");
});
