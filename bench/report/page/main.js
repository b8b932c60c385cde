// Starts the page: reads the data, builds the sections and connects them.
import {blob, inflate, setBlobFolder} from "./blobs.js";
import {cellDetails} from "./cell_details.js";
import {redrawCharts} from "./chart.js";
import {comparisonSection} from "./comparison.js";
import {disputesSection} from "./disputes.js";
import {announce, choice, element, refill, section} from "./dom.js";
import {costNamed, knownCosts} from "./cost_chart.js";
import {METRICS, makeModel} from "./model.js";
import {Pictures} from "./pictures.js";
import {findCell, linkTo, onPlace, readPlace, replacePlace} from "./places.js";
import {
  aboutView,
  answerSection,
  bestOf,
  cellTable,
  chartsOf,
  circumstancesSection,
  firstLine,
  overviewTable,
} from "./sections.js";
import {Viewer} from "./viewer.js";

class Page {
  constructor(meta, runs) {
    this.meta = meta;
    this.model = runs.at(-1).model;
    for (const view of this.model.views) view.orders = meta.orders;
    this.pictures = runs.at(-1).pictures;
    this.before = runs.length > 1 ? runs[0] : null;
    this.earlierIndex = new Map(meta.comparison?.cells.map(({before, after}) => [after, before]));
    this.settings = {view: this.model.views[0], metric: "flip_hdr", region: "mask", truth: "converged", cost: "ratio"};
    this.viewer = new Viewer({
      picturesOf: () => this.pictures,
      alternatives: (cell) => this.alternatives(cell),
      onMove: (cell) => this.open(cell),
      onMode: () => this.cell && replacePlace(this.cell, {mode: this.viewer.mode}),
    });
    this.context = {
      model: this.model,
      view: () => this.settings.view,
      question: () => this.questionFor(this.settings.view),
      cost: () => costNamed(this.settings.cost),
      openIndex: (index) => this.openIndex(index),
    };
  }

  questionFor(view) {
    const {metric, region, truth} = this.settings;
    return {metric, truth, region: region === "mask" && view.hasMask ? "mask" : "whole"};
  }

  // What a cell's picture may be held against beside the reference.
  alternatives(cell) {
    const others = [];
    const earlier = this.before?.model.cells[this.earlierIndex.get(cell.index)];
    if (earlier)
      others.push({
        value: "before",
        title: "the run before",
        path: earlier.pictures?.rendered,
        pictures: this.before.pictures,
      });
    for (const sequence of cell.sequence.view.sequences) {
      const other = sequence.cells.find((c) => c.frame === cell.frame);
      if (sequence !== cell.sequence && this.pictures.has(other?.pictures?.rendered))
        others.push({
          value: sequence.label,
          title: sequence.label,
          path: other.pictures.rendered,
          pictures: this.pictures,
        });
    }
    return others;
  }

  build() {
    const {provenance, cells} = this.model;
    document.getElementById("title").textContent = `${provenance.suite_name}: error and cost of reflection probes`;
    document.getElementById("subtitle").textContent = firstLine(provenance, cells.length);
    this.controls = element("div", {class: "controls sticky"});
    this.charts = element("div");
    this.about = element("p", {class: "note"});
    this.table = element("div");
    this.details = element(
      "div",
      {class: "details"},
      element("p", {}, "Choose a technique in the table or a point in a chart."),
    );
    const overview = overviewTable(
      this.model,
      (view) => ({...this.questionFor(view), metric: "flip_hdr"}),
      (view) => {
        this.setting("view", view);
        document.getElementById("errors").scrollIntoView();
      },
    );
    document
      .getElementById("main")
      .append(
        ...[
          answerSection(this.meta.answer),
          section("overview", "Overview", overview),
          this.meta.comparison && comparisonSection(this.meta.comparison, this.model),
          this.controls,
          section("errors", "Errors and costs", this.about, this.charts),
          section("techniques", "Techniques", this.table),
          section("cell", "Pictures and numbers of a cell", this.details),
          disputesSection(this.meta.disputes, this.model, this.pictures),
          circumstancesSection(this.model),
        ].filter(Boolean),
      );
    document
      .getElementById("contents")
      .append(
        ...[...document.querySelectorAll("main > section")].map((s) =>
          element("a", {href: `#${s.id}`}, s.querySelector("h2").textContent),
        ),
      );
    this.fillView();
  }

  fillControls() {
    const {views} = this.model,
      {view} = this.settings;
    const select = (label, name, options, value = this.settings[name]) =>
      choice(label, options, value, (chosen) => this.setting(name, chosen));
    const titled = (list) => list.map(({key, title}) => ({value: key, title}));
    const known = knownCosts(view);
    // Without measured times there is the probes' memory.
    if (known.length && !known.some((cost) => cost.key === this.settings.cost)) this.settings.cost = known[0].key;
    const hasMatched = view.sequences.some((s) => s.cells.some((cell) => cell.matched));
    refill(
      this.controls,
      choice(
        "Scene",
        views.map((v) => ({value: v.id, title: v.title})),
        view.id,
        (id) =>
          this.setting(
            "view",
            views.find((v) => v.id === id),
          ),
      ),
      select("Metric", "metric", titled(METRICS)),
      view.hasMask &&
        select("Region", "region", [
          {value: "mask", title: "mask: reflective and refractive objects"},
          {value: "whole", title: "whole image"},
        ]),
      hasMatched &&
        select("Truth", "truth", [
          {value: "converged", title: "converged"},
          {value: "matched", title: "own number of bounces"},
        ]),
      known.length > 1 && select("Cost", "cost", titled(known)),
    );
    const isSticky = getComputedStyle(this.controls).position === "sticky";
    document.documentElement.style.scrollPaddingTop = isSticky ? `${this.controls.offsetHeight + 12}px` : "";
  }

  setting(name, value) {
    this.settings[name] = value;
    this.fillView();
  }

  fillView() {
    this.fillControls();
    this.about.textContent = aboutView(this.settings.view);
    const {charts, elements} = chartsOf(this.context);
    refill(this.charts, elements);
    charts.forEach((chart) => chart.draw());
    this.cells = cellTable(this.context);
    refill(this.table, this.cells.element);
    this.cells.mark(this.cell?.sequence.label);
  }

  // --- Cells

  openIndex(index) {
    location.hash = linkTo(this.settings.view.sequences.flatMap((s) => s.cells).find((cell) => cell.index === index));
  }

  open(cell) {
    const isNew = cell.sequence !== this.cell?.sequence;
    this.cell = cell;
    if (cell.sequence.view !== this.settings.view) this.setting("view", cell.sequence.view);
    this.cells.mark(cell.sequence.label);
    replacePlace(cell, {mode: this.viewer.mode});
    const focused = document.activeElement?.className;
    refill(this.details, cellDetails(cell, this.viewer, this.pictures));
    if (!isNew && focused) this.details.querySelector(`.${CSS.escape(focused)}`)?.focus({preventScroll: true});
    announce(`${cell.sequence.label}, frame ${cell.frame}`);
    return this.viewer.open(cell);
  }

  openPlace(place) {
    if (!place.cell) return;
    const cell = findCell(this.model, place.cell);
    if (!cell) {
      this.details.replaceChildren(element("p", {class: "message"}, `This run has no cell '${place.cell}'.`));
    } else {
      if (place.mode) this.viewer.mode !== place.mode && this.viewer.setMode(place.mode);
      this.open(cell);
    }
    document.getElementById("cell").scrollIntoView();
  }

  listen() {
    onPlace((place) => this.openPlace(place));
    document.addEventListener("keydown", (event) => {
      if (
        event.ctrlKey ||
        event.metaKey ||
        event.altKey ||
        event.target.closest?.("input:not([type=radio]):not([type=range]), select, textarea")
      )
        return;
      if (this.viewer.key(event.key)) event.preventDefault();
    });
  }
}

function startTheme() {
  const select = document.getElementById("theme");
  // Charts are drawn for the width that they are printed at: scaled down, their text could not be read.
  const apply = (theme, printing = false) => {
    document.documentElement.dataset.theme = theme;
    document.documentElement.classList.toggle("printing", printing);
    redrawCharts();
  };
  let chosen = "auto";
  select.addEventListener("change", () => apply((chosen = select.value)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawCharts);
  globalThis.addEventListener("beforeprint", () => apply("light", true));
  globalThis.addEventListener("afterprint", () => apply(chosen));
}

async function start() {
  const meta = JSON.parse(document.getElementById("meta").textContent);
  setBlobFolder(meta.beside);
  const runs = await Promise.all(
    meta.runs.map(async (run) => {
      const text = new TextDecoder().decode(await inflate(await blob(run.results)));
      return {name: run.name, model: makeModel(JSON.parse(text)), pictures: new Pictures(run.pictures)};
    }),
  );
  startTheme();
  const page = new Page(meta, runs);
  page.build();
  page.listen();
  const view = page.settings.view;
  if (readPlace().cell) page.openPlace(readPlace());
  else await page.open(bestOf(view, page.questionFor(view)).cells.at(-1));
  document.documentElement.dataset.ready = "yes";
}

start().catch((error) => {
  document
    .getElementById("main")
    .append(element("p", {class: "message"}, `The report can't be shown: ${error.message}`));
  throw error;
});
