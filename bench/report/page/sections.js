// The sections of the page that show a view's numbers.
import {numberColumn} from "./cell_details.js";
import {element, section} from "./dom.js";
import {costScatter, frontOf, knownCosts} from "./cost_chart.js";
import {axisChart, timeCharts} from "./error_charts.js";
import {COSTS, METRICS, faceAgeOf, isMoreBetter, meanError, p95Error, worstError} from "./model.js";
import {mean} from "./numbers.js";
import {linkTo} from "./places.js";
import {Table} from "./table.js";
import {waterfallPanel} from "./waterfall.js";

export function answerSection(answer) {
  return (
    answer.length > 0 &&
    section(
      "answer",
      "Answer",
      element(
        "ol",
        {class: "answer"},
        answer.map((line) => element("li", {}, line)),
      ),
    )
  );
}

// Of several with the smallest error the cheapest, as in the tables of report.md.
export function bestOf(view, question) {
  const sign = isMoreBetter(question.metric) ? -1 : 1;
  const loss = (sequence) => sign * meanError(sequence, question);
  const cost = (sequence) => COSTS[0].of(sequence.cells[0]) ?? Infinity;
  const isBetter = (a, b) => loss(a) < loss(b) || (loss(a) === loss(b) && cost(a) < cost(b)) || Number.isNaN(loss(b));
  return view.sequences.reduce((best, s) => (isBetter(s, best) ? s : best));
}

// One row a view: where to start reading.
export function overviewTable(model, questionFor, chooseView) {
  const cost = COSTS[0];
  const link = (sequence) => (sequence ? element("a", {href: linkTo(sequence.cells.at(-1))}, sequence.label) : "–");
  const rows = model.views.map((view) => {
    const question = questionFor(view);
    const front = frontOf(view, question, cost);
    return {view, question, best: bestOf(view, question), cheapest: front[0]?.sequence};
  });
  const text = (key, title, of, cell) => ({key, title, left: true, text: of, ...(cell ? {cell} : {})});
  return new Table({
    caption: "Scenes",
    rows,
    filterable: false,
    rowKey: (row) => row.view.id,
    columns: [
      text(
        "scene",
        "scene",
        (row) => row.view.title,
        (row) =>
          element("button", {type: "button", class: "link", onclick: () => chooseView(row.view)}, row.view.title),
      ),
      {
        key: "techniques",
        title: "techniques",
        value: (row) => row.view.sequences.length,
        text: (row) => String(row.view.sequences.length),
      },
      {
        key: "frames",
        title: "frames",
        value: (row) => row.view.frames.length,
        text: (row) => String(row.view.frames.length),
      },
      {
        ...text(
          "best",
          "smallest error",
          (row) => row.best.label,
          (row) => link(row.best),
        ),
        wrap: true,
      },
      numberColumn("best-error", "FLIP-HDR", (row) => meanError(row.best, row.question)),
      numberColumn("best-cost", "× plain", (row) => cost.of(row.best.cells[0]) ?? NaN),
      {
        ...text(
          "cheapest",
          "cheapest",
          (row) => row.cheapest?.label ?? "–",
          (row) => link(row.cheapest),
        ),
        wrap: true,
      },
      numberColumn("cheapest-error", "FLIP-HDR", (row) => (row.cheapest ? meanError(row.cheapest, row.question) : NaN)),
      numberColumn("cheapest-cost", "× plain", (row) => (row.cheapest ? cost.of(row.cheapest.cells[0]) : NaN)),
    ],
  }).element;
}

export function aboutView(view) {
  const axes = view.axes.map((axis) => `${axis.name} ${axis.values.join(", ")}`).join("; ");
  return `${view.title}, ${view.frames.length > 1 ? `frames ${view.frames.join(" ")}` : `frame ${view.frames[0]}`}${axes ? `: ${axes}` : ""}`;
}

// Draws when it is in the page.
export function chartsOf(context) {
  const view = context.view();
  const waterfall = waterfallPanel(context);
  const scatter = costScatter(context);
  const lines = [
    ...view.axes.map((axis) => axisChart(context, axis)),
    ...(view.frames.length > 1 ? timeCharts(context) : []),
  ];
  return {
    charts: [scatter, ...lines, ...(waterfall ? [waterfall.chart] : [])],
    elements: [
      scatter.element,
      waterfall?.element,
      element(
        "div",
        {class: "charts"},
        lines.map((chart) => chart.element),
      ),
    ].filter(Boolean),
  };
}

function costColumns(view) {
  return knownCosts(view).map((cost) =>
    numberColumn(
      cost.key,
      {ratio: "× plain", p99: "p99 ms", renders: "renders"}[cost.key] ?? cost.title,
      (s) => cost.of(s.cells[0]) ?? NaN,
    ),
  );
}

// One row a technique: means over its frames.
export function cellTable(context) {
  const view = context.view(),
    question = context.question();
  const front = new Set(frontOf(view, question, context.cost()).map((choice) => choice.sequence));
  const errorColumns = METRICS.filter((m) => ["flip_hdr", "relmse", "ssim", question.metric].includes(m.key)).flatMap(
    (m) => {
      const asked = {...question, metric: m.key};
      return [
        numberColumn(m.key, m.title, (s) => meanError(s, asked)),
        ...(view.frames.length > 1 && m.key === question.metric
          ? [
              numberColumn("p95", "p95", (s) => p95Error(s, asked), {
                note: "95 % of the frames do not exceed it: the worst of fewer than 20",
              }),
              numberColumn("worst", "worst frame", (s) => worstError(s, asked)),
            ]
          : []),
      ];
    },
  );
  const axes = view.axes.map((axis) => ({
    key: axis.name,
    title: axis.name,
    left: true,
    text: (s) => s.technique[axis.name] ?? "–",
  }));
  const open = {
    key: "open",
    title: "picture",
    left: true,
    value: (s) => s.label,
    text: () => "",
    cell: (s) => element("a", {href: linkTo(s.cells.at(-1)), "aria-label": `picture of ${s.label}`}, "view"),
  };
  const columns = [
    open,
    ...axes,
    ...errorColumns,
    ...costColumns(view),
    numberColumn("age", "face age", (s) => mean(s.cells.map(faceAgeOf)), {
      note: "frames since the capture, mean over faces and frames",
    }),
    {
      key: "front",
      title: "front",
      note: "on the Pareto front of error and cost",
      value: (s) => Number(front.has(s)),
      text: (s) => (front.has(s) ? "●" : ""),
    },
  ];
  return new Table({
    caption: `Techniques on ${view.title}, ${question.region === "mask" ? "errors of the mask" : "errors of the whole image"}${view.frames.length > 1 ? ", mean over the frames" : ""}`,
    columns,
    rows: view.sequences,
    rowKey: (s) => s.label,
    hint: `words, ${view.axes[0] ? `${view.axes[0].name}=${view.axes[0].values.at(-1)}, ` : ""}flip_hdr<0.1`,
  });
}

export function circumstancesSection(model) {
  const p = model.provenance;
  const rows = [
    ["probebench", `${p.tool_version} (${p.git_hash})`],
    ["suite", `${p.suite_name} (${p.suite_hash})`],
    ["started", p.started_at],
    ["control", p.control_outcome],
    ["seed", String(p.seed)],
    ["CPU", `${p.cpu}, ${p.threads} threads`],
    ["GL", `${p.gl_backend}: ${p.gl_renderer}, ${p.gl_version}`],
    ...Object.entries(p.settings),
    ...Object.entries(p.scene_hashes).map(([scene, hash]) => [`scene ${scene}`, hash]),
    ...Object.entries(p.libraries),
  ];
  return section(
    "circumstances",
    "Circumstances",
    new Table({
      caption: "How the numbers were made",
      rows,
      filterable: false,
      columns: [
        {key: "name", title: "circumstance", left: true, text: (row) => row[0]},
        {key: "value", title: "value", left: true, text: (row) => row[1]},
      ],
    }).element,
  );
}

export const firstLine = (p, cells) =>
  `${cells} cells, control ${p.control_outcome}, probebench ${p.tool_version} (${p.git_hash}), ${p.gl_renderer}, ${p.started_at}`;
