// The page as people use it: node browser.mjs PACKAGES PAGE [FOLDER FOR SCREENSHOTS]. PACKAGES holds node_modules.
import assert from "node:assert/strict";
import {createRequire} from "node:module";
import {pathToFileURL} from "node:url";

const [packages, file, pictures] = process.argv.slice(2);
const {chromium} = createRequire(`${packages}/`)("playwright-core");
const browser = await chromium.launch({executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"]});

async function open(width, colorScheme) {
  const context = await browser.newContext({viewport: {width, height: 900}, colorScheme, offline: true});
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asks for ${request.url()}`); });
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector("html[data-ready]");
  return {page, complaints, done: async () => { assert.deepEqual(complaints, []); await context.close(); }};
}

try {
  const {page, done} = await open(1400, "light");
  const data = await page.evaluate(() => JSON.parse(document.getElementById("gnomon-data").textContent));

  // Each job with an error and a time has a mark in the chart of its section.
  const drawable = data.records.filter((r) => r.error?.rmse > 0 && r.time?.regimes?.dynamic?.median_ms > 0).map((r) => r.job);
  assert.ok(drawable.length > 1, "the results hold something to draw");
  const marks = await page.$$eval("[data-cost=ms] [data-job]", (dots) => dots.map((dot) => dot.dataset.job));
  assert.deepEqual([...marks].sort(), [...drawable].sort());

  // A chart has its table, with a row a mark.
  assert.equal(await page.$$eval("[data-cost=ms] tbody tr", (rows) => rows.length), drawable.length);

  // What the reference took and is worth stands below.
  const reference = data.records.find((r) => r.reference?.rays > 0).reference;
  const note = await page.locator("section").first().locator("p.note", {hasText: "reference"}).first().textContent();
  assert.equal(/It took [\d\s]+ rays/.test(note), true, note);
  assert.equal(/could do without/.test(note), reference.rays_saved > 0, note);
  assert.equal(/exact integral/.test(note), reference.cosine_floor > 0, note);

  // A click on a mark, and Enter on another, open their pictures.
  const drawn = async (change) => {
    const before = await page.getAttribute(".comparison", "data-drawn");
    await change();
    await page.waitForFunction((was) => document.querySelector(".comparison").dataset.drawn !== was, before);
  };
  const first = page.locator("section").first().locator("[data-cost=ms] [data-job]");
  for (const [i, act] of [[0, (dot) => dot.click({force: true})], [1, (dot) => dot.press("Enter")]]) {
    const job = await first.nth(i).getAttribute("data-job");
    await drawn(() => act(first.nth(i)));
    assert.equal(await page.getAttribute(".comparison", "data-left"), job);
  }

  // The number under the cursor is the one of the file: the reference under the right half.
  const canvas = page.locator("canvas.comparer").first();
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  await page.mouse.move(box.x + 0.75 * box.width, box.y + 0.5 * box.height);
  await page.waitForFunction(() => /\(\d+, \d+\)/.test(document.querySelector(".readout").textContent));
  assert.match(await page.textContent(".readout"), /visibility .* signed error .*\|.*reference: visibility/);

  // Keys: a digit shows a job, e and E change the exposure, the wheel zooms, r resets.
  await page.locator(".comparison").first().focus();
  const pictured = data.records.filter((r) => data.pictures[r.job] && r.scene === data.records[0].scene && r.light === data.records[0].light);
  await drawn(() => page.keyboard.press("2"));
  assert.equal(await page.getAttribute(".comparison", "data-left"), pictured[1].job);
  await drawn(() => page.keyboard.press("E"));
  assert.match(await page.textContent(".exposure"), /exposure \+1/);
  await drawn(() => page.mouse.wheel(0, -300));
  assert.equal(Number(await page.getAttribute(".comparison", "data-scale")), 2);
  await drawn(() => page.keyboard.press("r"));
  assert.equal(Number(await page.getAttribute(".comparison", "data-scale")), 1);
  assert.equal((await page.textContent(".exposure")).trim(), "");

  // A heading sorts, and the other way at the next click.
  const heading = page.locator("section").first().locator("table").filter({hasText: "Every job"}).locator("th[scope=col]").nth(1);
  await heading.locator("button").click();
  assert.equal(await heading.getAttribute("aria-sort"), "ascending");
  await heading.locator("button").click();
  assert.equal(await heading.getAttribute("aria-sort"), "descending");

  // Another figure draws other charts.
  await page.locator("section").first().locator("label", {hasText: "accuracy by"}).locator("select").selectOption({index: 1});
  assert.match(await page.textContent("[data-cost=ms] h3"), /band/);
  if (pictures) await page.pdf({path: `${pictures}/print.pdf`, format: "A4", printBackground: true});
  await done();

  for (const [width, scheme] of [[1400, "light"], [1400, "dark"], [400, "light"], [400, "dark"]]) {
    const view = await open(width, scheme);
    assert.ok(await view.page.evaluate(() => document.documentElement.scrollWidth) <= width, `nothing is wider than ${width} pixels`);
    if (pictures) await view.page.screenshot({path: `${pictures}/${width}-${scheme}.png`, fullPage: true});
    await view.done();
  }
  console.log("the page holds");
} finally {
  await browser.close();
}
