// Two pictures under one slider, and below them all pictures of a job: what moves one moves all.
import {element, choice} from "./dom.js";
import {numberText} from "./data.js";
import {halfFloats, kinds, painted} from "./pictures.js";

const help = "1–9 show a job · e/E exposure · r reset · wheel zooms at the cursor · drag moves · ←/→ move the divider";

/** `page` as readPage gives it. Returns {root, show(job)}. */
export function comparer(page, section) {
  const jobs = section.jobs.filter((job) => page.pictures[job.job]);
  if (jobs.length === 0) {
    return {root: element("p", {class: "note"}, page.withoutImages ?? "There are no pictures of these jobs: they come from the EXR files that a batch writes."), show: () => {}};
  }
  return new Comparer(page, jobs).handle();
}

class Comparer {
  constructor(page, jobs) {
    this.page = page;
    this.jobs = jobs;
    this.kind = kinds[0];
    this.view = {scale: 1, x: 0, y: 0};
    this.exposure = 0;
    this.split = 0.5;
    this.painted = new Map();
    const first = page.pictures[jobs[0].job];
    this.size = {width: first.width, height: first.height};
  }

  handle() {
    this.options = [...this.jobs.map((job) => ({title: job.label, job})), {title: "reference", job: null}];
    const errorOf = (option) => option.job?.error?.rmse ?? Infinity;
    const best = this.options.reduce((a, b) => (errorOf(b) < errorOf(a) ? b : a));
    this.sides = [best, this.options.at(-1)];
    this.main = this.canvas("comparer");
    this.small = kinds.map((kind) => ({kind, canvas: this.canvas("small")}));
    this.readout = element("output", {class: "readout", "aria-live": "off"}, "Move over a picture to read its numbers.");
    this.slider = element("input", {type: "range", min: "0", max: "1000", value: "500", class: "divider", "aria-label": "divider between left and right",
                                    input: () => this.moveDivider(this.slider.value / 1000)});
    this.controls = element("div", {class: "controls"});
    this.printed = element("p", {class: "printed"});  // paper shows no controls
    this.legend = element("div", {class: "scale"});
    this.root = element("div", {class: "comparison", tabindex: "0", role: "group", "aria-label": "comparer. " + help,
                                keydown: (event) => this.key(event)},
      this.controls, this.printed,
      element("div", {class: "stage"}, this.main, this.slider),
      this.legend, this.readout,
      element("div", {class: "smalls"}, this.small.map(({kind, canvas}) =>
        element("figure", {}, canvas, element("figcaption", {}, `${kind.title} of the left one`)))),
      element("p", {class: "note keys"}, help));
    for (const canvas of [this.main, ...this.small.map((s) => s.canvas)]) this.listen(canvas);
    this.refresh();
    return {root: this.root, show: (job) => this.show(job), state: this};
  }

  canvas(name) {
    return element("canvas", {class: name, width: String(this.size.width), height: String(this.size.height)});
  }

  /** A chosen job is the left one. */
  show(job) {
    const option = this.options.find((o) => o.job === job);
    if (!option) return;
    this.sides[0] = option;
    this.refresh();
    this.root.scrollIntoView({block: "nearest"});
  }

  refresh() {
    this.controls.replaceChildren(
      choice("left", this.options, this.sides[0], (o) => { this.sides[0] = o; this.refresh(); }),
      choice("right", this.options, this.sides[1], (o) => { this.sides[1] = o; this.refresh(); }),
      choice("showing", kinds, this.kind, (kind) => { this.kind = kind; this.refresh(); }));
    this.root.dataset.left = this.sides[0].job?.job ?? "reference";
    this.root.dataset.right = this.sides[1].job?.job ?? "reference";
    this.root.dataset.kind = this.kind.key;
    this.printed.textContent = `Left ${this.sides[0].title}, right ${this.sides[1].title}: ${this.kind.title}.`;
    const stops = Array.from({length: 33}, (_, i) => `rgb(${this.kind.at(i / 32).map(Math.round).join(",")})`);
    this.legend.replaceChildren(element("span", {}, this.kind.legend[0]),
      element("span", {class: "gradient", style: `background:linear-gradient(to right,${stops.join(",")})`}),
      element("span", {}, this.kind.legend[1]),
      element("span", {class: "exposure"}, this.exposure === 0 ? "" : ` exposure ${this.exposure > 0 ? "+" : ""}${this.exposure}`));
    this.draw();
  }

  /** Values of a picture; null where there is none. The reference has no error, and nothing is known of its work. */
  async values(option, kind) {
    const count = this.size.width * this.size.height;
    const pictures = option.job ? this.page.pictures[option.job.job] : this.page.pictures[(this.sides.find((s) => s.job) ?? this.options[0]).job.job];
    const reference = await halfFloats(this.page.references[pictures.reference], count);
    if (!option.job) return kind.key === "visibility" ? reference : kind.key === "error" ? reference.map((v) => (Number.isNaN(v) ? v : 0)) : null;
    if (kind.key === "work") return pictures.work ? halfFloats(pictures.work, count) : null;
    const error = await halfFloats(pictures.error, count);
    return kind.key === "error" ? error : error.map((e, i) => e + reference[i]);
  }

  async picture(option, kind) {
    const key = `${option.job?.job ?? "reference"} ${kind.key} ${this.exposure}`;
    if (!this.painted.has(key)) {
      const values = await this.values(option, kind);
      if (this.painted.size > 60) this.painted.clear();
      this.painted.set(key, values && {values, canvas: painted(values, this.size.width, this.size.height, kind, this.exposure)});
    }
    return this.painted.get(key);
  }

  async draw() {
    const ticket = (this.ticket = (this.ticket ?? 0) + 1);
    const [left, right] = await Promise.all(this.sides.map((side) => this.picture(side, this.kind)));
    const smalls = await Promise.all(this.small.map(({kind}) => this.picture(this.sides[0], kind)));
    if (ticket !== this.ticket) return;  // something newer is being drawn
    const at = Math.round(this.split * this.size.width);
    this.put(this.main, left, 0, at);
    this.put(this.main, right, at, this.size.width);
    const context = this.main.getContext("2d");
    context.fillStyle = "#ffffff";
    context.fillRect(at - 1, 0, 2, this.size.height);
    this.small.forEach(({canvas}, i) => this.put(canvas, smalls[i], 0, this.size.width));
    this.root.dataset.drawn = String(ticket);
  }

  /** The columns from `from` to `to` of a canvas. */
  put(canvas, picture, from, to) {
    const context = canvas.getContext("2d");
    context.save();
    context.beginPath();
    context.rect(from, 0, to - from, this.size.height);
    context.clip();
    context.fillStyle = "#46464a";
    context.fillRect(0, 0, this.size.width, this.size.height);
    context.imageSmoothingEnabled = false;
    if (picture) {
      context.setTransform(this.view.scale, 0, 0, this.view.scale, this.view.x, this.view.y);
      context.drawImage(picture.canvas, 0, 0);
    } else {
      context.fillStyle = "#c8c8cc";
      context.fillText("not known", from + 8, 16);
    }
    context.restore();
  }

  moveDivider(split) {
    this.split = Math.max(0, Math.min(1, split));
    this.slider.value = String(Math.round(1000 * this.split));
    this.draw();
  }

  /** Where an event lies on a canvas, in its pixels. */
  placeOf(event, canvas) {
    const box = canvas.getBoundingClientRect();
    return {x: (event.clientX - box.left) / box.width * this.size.width, y: (event.clientY - box.top) / box.height * this.size.height};
  }

  listen(canvas) {
    let grabbed = null;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const place = this.placeOf(event, canvas);
      const scale = Math.max(1, Math.min(64, this.view.scale * 2 ** (-event.deltaY / 300)));
      const factor = scale / this.view.scale;
      this.moveTo(scale, place.x - (place.x - this.view.x) * factor, place.y - (place.y - this.view.y) * factor);
    }, {passive: false});
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      const place = this.placeOf(event, canvas);
      const onDivider = canvas === this.main && Math.abs(place.x - this.split * this.size.width) < 0.03 * this.size.width;
      grabbed = {place, x: this.view.x, y: this.view.y, divider: onDivider || (canvas === this.main && this.view.scale === 1)};
      if (grabbed.divider) this.moveDivider(place.x / this.size.width);
    });
    canvas.addEventListener("pointermove", (event) => {
      const place = this.placeOf(event, canvas);
      if (grabbed?.divider) this.moveDivider(place.x / this.size.width);
      else if (grabbed) this.moveTo(this.view.scale, grabbed.x + place.x - grabbed.place.x, grabbed.y + place.y - grabbed.place.y);
      this.tell(place);
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { grabbed = null; });
  }

  moveTo(scale, x, y) {
    const clamp = (v, extent) => Math.min(0, Math.max(extent * (1 - scale), v));
    this.view = {scale, x: clamp(x, this.size.width), y: clamp(y, this.size.height)};
    this.root.dataset.scale = scale.toFixed(3);
    this.draw();
  }

  /** The numbers of both sides under the cursor. */
  async tell(place) {
    const x = Math.floor((place.x - this.view.x) / this.view.scale);
    const y = Math.floor((place.y - this.view.y) / this.view.scale);
    if (x < 0 || y < 0 || x >= this.size.width || y >= this.size.height) return;
    const parts = [];
    for (const side of this.sides) {
      const own = [];
      for (const kind of kinds) {
        const values = await this.values(side, kind);
        const value = values?.[y * this.size.width + x];
        if (value !== undefined) own.push(`${kind.title} ${Number.isNaN(value) ? "none" : numberText(value, 4)}`);
      }
      parts.push(`${side.title}: ${own.join(", ")}`);
    }
    this.readout.textContent = `(${x}, ${y})  ${parts.join("  |  ")}`;
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    const digit = "123456789".indexOf(event.key);
    if (digit >= 0 && digit < this.jobs.length) this.show(this.jobs[digit]);
    else if (event.key === "e" || event.key === "E") { this.exposure += event.key === "E" ? 1 : -1; this.refresh(); }
    else if (event.key === "r") { this.exposure = 0; this.split = 0.5; this.slider.value = "500"; this.moveTo(1, 0, 0); this.refresh(); }
    else if ((event.key === "ArrowLeft" || event.key === "ArrowRight") && event.target !== this.slider) this.moveDivider(this.split + (event.key === "ArrowLeft" ? -0.02 : 0.02));
    else return;
    event.preventDefault();
  }
}
