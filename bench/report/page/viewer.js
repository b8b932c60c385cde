// The pictures of a cell against the reference or another cell's: flipped in place, side by side, split, as a difference and
// as FLIP's map of the error.
import {announce, choice, element} from "./dom.js";
import {significant} from "./numbers.js";
import {valueAt} from "./pictures.js";
import {Lens, Stage} from "./stage.js";
import {MAX_STOPS, MODES, exposureControls, keyHelp, modeControls, zoomControls} from "./viewer_controls.js";
import {Developer, planOf} from "./viewer_plan.js";

export class Viewer {
  // picturesOf(cell): the Pictures of the cell's run. alternatives(cell): [{value, title, path, pictures}] beside the reference.
  // onMove(cell): another frame or technique is wanted. onMode(): the address should tell the mode.
  constructor({picturesOf, alternatives, onMove, onMode}) {
    Object.assign(this, {
      picturesOf,
      alternatives,
      onMove,
      onMode,
      mode: "flip",
      flipped: false,
      stops: 0,
      divider: 0.5,
      against: "reference",
    });
    this.lens = new Lens(() => this.draw());
    this.stages = [new Stage(this.lens), new Stage(this.lens)];
    this.stages[0].onDivider = null;
    this.developer = new Developer();
    this.build();
    new ResizeObserver(() => this.draw()).observe(this.screen);
  }

  build() {
    this.message = element("p", {class: "message", hidden: true});
    this.pixel = element("output", {class: "pixel"}, "\u00a0");
    this.screen = element(
      "div",
      {class: "screen"},
      this.stages.map((stage) => stage.element),
    );
    for (const stage of this.stages) {
      stage.canvas.addEventListener("pointermove", (event) => this.readPixel(stage, event));
      stage.canvas.addEventListener("click", () => this.element.focus({preventScroll: true}));
    }
    this.toolbar = element(
      "div",
      {class: "toolbar"},
      modeControls(this),
      (this.againstPlace = element("span")),
      exposureControls(this),
      zoomControls(this.lens),
      (this.framePlace = element("span", {class: "frames"})),
    );
    this.legend = element("p", {class: "map-legend"}, "FLIP 0", element("span", {class: "magma"}), "1");
    this.element = element(
      "div",
      {
        class: "viewer",
        tabindex: 0,
        role: "group",
        "aria-label": "Pictures",
        onkeydown: (event) => this.spaceKey(event),
      },
      this.toolbar,
      this.screen,
      this.message,
      element("div", {class: "below"}, this.pixel, this.legend),
      keyHelp(),
    );
  }

  // --- What is shown

  async open(cell) {
    this.cell = cell;
    this.fillAgainst();
    this.fillFrames();
    await this.load();
  }

  fillAgainst() {
    this.others = [
      {
        value: "reference",
        title: "reference",
        path: this.cell.pictures?.reference,
        pictures: this.picturesOf(this.cell),
      },
      ...this.alternatives(this.cell),
    ];
    if (!this.others.some((other) => other.value === this.against)) this.against = "reference";
    this.againstPlace.replaceChildren(
      choice("Against", this.others, this.against, (value) => {
        this.against = value;
        this.load();
      }),
    );
  }

  fillFrames() {
    const {cells} = this.cell.sequence,
      at = cells.indexOf(this.cell);
    this.framePlace.replaceChildren();
    if (cells.length < 2) return;
    const slider = element("input", {
      type: "range",
      min: 0,
      max: cells.length - 1,
      value: at,
      class: "scrubber",
      "aria-valuetext": `frame ${this.cell.frame}`,
      oninput: () => this.onMove(cells[Number(slider.value)]),
    });
    this.framePlace.append(
      element("label", {class: "choice"}, "Frame", slider, element("output", {}, String(this.cell.frame))),
    );
  }

  async load() {
    const cell = this.cell,
      own = this.picturesOf(cell),
      other = this.others.find((o) => o.value === this.against);
    const known = (pictures, path) => (pictures.has(path) ? pictures.hdr(path) : undefined);
    try {
      const [rendered, against, map] = await Promise.all([
        known(own, cell.pictures?.rendered),
        known(other.pictures, other.path),
        own.has(cell.pictures?.flip) ? own.png(cell.pictures.flip) : undefined,
      ]);
      if (this.cell !== cell) return; // another one was opened meanwhile
      this.shown = {rendered, against, map, againstTitle: other.title};
      this.say(
        rendered
          ? ""
          : against
            ? 'The run kept no picture of this frame: a suite with [images] frames = "all" keeps those of every frame. This is the reference.'
            : "The run's folder has no pictures of this cell.",
      );
    } catch (error) {
      this.shown = undefined;
      this.say(`The pictures can't be shown: ${error.message}.`);
    }
    const size = this.shown?.rendered ?? this.shown?.against;
    if (size) this.screen.style.setProperty("--aspect", `${size.width} / ${size.height}`);
    this.screen.hidden = !size;
    this.draw();
    this.element.dataset.ready = cell.shortKey;
  }

  say(text) {
    this.message.textContent = text;
    this.message.hidden = !text;
  }

  draw() {
    if (!this.shown?.rendered && !this.shown?.against) return;
    const plan = planOf(this);
    this.screen.dataset.stages = plan.length;
    this.legend.classList.toggle("shown", this.mode === "error");
    this.stages.forEach((stage, i) => {
      stage.element.hidden = !plan[i];
      if (!plan[i]) return;
      stage.label.textContent = plan[i].label;
      stage.canvas.setAttribute("aria-label", `${plan[i].label}, ${this.cell.shortKey}`);
      stage.onDivider = plan[i].divider
        ? {
            position: () => this.divider,
            move: (x) => {
              this.divider = x;
              this.draw();
            },
          }
        : null;
      stage.element.style.setProperty("--divider", plan[i].divider ? `${100 * this.divider}%` : "-10px");
      stage.draw(plan[i].parts);
    });
  }

  readPixel(stage, event) {
    const {rendered, against, againstTitle} = this.shown ?? {};
    const picture = rendered ?? against;
    if (!picture) return;
    const [x, y] = stage.pixelOf(event, picture.width, picture.height);
    const text = (title, image) =>
      image &&
      `${title} ${valueAt(image, x, y)
        .map((v) => significant(v))
        .join(" ")}`;
    this.pixel.textContent = [`pixel ${x}, ${y}`, text("rendered", rendered), text(againstTitle, against)]
      .filter(Boolean)
      .join("   ");
  }

  // --- What can be done

  setMode(mode) {
    if (!MODES.some((m) => m.key === mode)) return;
    this.mode = mode;
    for (const input of this.toolbar.querySelectorAll(".modes input")) input.checked = input.value === mode;
    this.draw();
    this.onMode();
  }

  flip() {
    if (this.mode !== "flip") this.setMode("flip");
    this.flipped = !this.flipped;
    this.draw();
    announce(this.stages[0].label.textContent);
  }

  setStops(stops) {
    this.stops = Math.min(Math.max(stops, -MAX_STOPS), MAX_STOPS);
    this.exposure.value = this.stops;
    this.exposureText.textContent = `${this.stops < 0 ? "−" : "+"}${Math.abs(this.stops).toFixed(1)} stops`;
    this.draw();
  }

  showRectangle({x, y, width, height}) {
    const picture = this.shown?.rendered ?? this.shown?.against;
    if (picture)
      this.lens.showRectangle(x / picture.width, y / picture.height, width / picture.width, height / picture.height);
    this.element.scrollIntoView({block: "nearest"});
  }

  // Of this technique, by so many frames.
  moveFrame(by) {
    const {cells} = this.cell.sequence;
    const next = cells[cells.indexOf(this.cell) + by];
    if (next) this.onMove(next);
  }

  // To another technique, at this frame if it has it.
  moveTechnique(by) {
    const {sequences} = this.cell.sequence.view;
    const next = sequences[sequences.indexOf(this.cell.sequence) + by];
    if (next) this.onMove(next.cells.find((cell) => cell.frame === this.cell.frame) ?? next.cells.at(-1));
  }

  spaceKey(event) {
    if (event.key !== " " || event.target !== this.element) return;
    event.preventDefault();
    this.flip();
  }

  // Of the whole page; true where the key means something.
  key(key) {
    const actions = {
      f: () => this.flip(),
      "[": () => this.setStops(this.stops - 0.5),
      "]": () => this.setStops(this.stops + 0.5),
      "+": () => this.lens.zoomBy(2),
      "=": () => this.lens.zoomBy(2),
      "-": () => this.lens.zoomBy(0.5),
      0: () => {
        this.setStops(0);
        this.lens.reset();
      },
      ",": () => this.moveFrame(-1),
      ".": () => this.moveFrame(1),
      p: () => this.moveTechnique(-1),
      n: () => this.moveTechnique(1),
    };
    MODES.forEach((mode, i) => {
      actions[i + 1] = () => this.setMode(mode.key);
    });
    if (!this.cell || !(key in actions)) return false;
    actions[key]();
    return true;
  }
}
