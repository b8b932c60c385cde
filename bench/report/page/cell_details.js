// The numbers of one cell: its errors by region, its cost and work, and its errors by object and material.
import {fillCrops} from "./crops.js";
import {element} from "./dom.js";
import {METRICS, errorOf, faceAgeOf, floorOf, intervalOf} from "./model.js";
import {percent, significant} from "./numbers.js";
import {linkTo} from "./places.js";
import {Table} from "./table.js";

// A column of numbers; the exact one shows when pointed at.
export function numberColumn(key, title, valueOf, more = {}) {
  return {
    key,
    title,
    value: valueOf,
    text: (row) => significant(valueOf(row)),
    cell: (row) =>
      element(
        "span",
        {title: Number.isFinite(valueOf(row)) ? String(valueOf(row)) : undefined},
        significant(valueOf(row)),
      ),
    ...more,
  };
}

function errorTable(cell) {
  const regions = cell.mask_metrics ? ["mask", "whole"] : ["whole"];
  const columns = [{key: "metric", title: "metric", left: true, text: (row) => row.title}];
  for (const region of regions) {
    const name = region === "mask" ? "mask" : "whole image";
    const question = (row, truth = "converged") => ({metric: row.key, region, truth});
    columns.push(numberColumn(region, name, (row) => errorOf(cell, question(row))));
    if (METRICS.some((row) => intervalOf(cell, question(row))))
      columns.push({
        key: `${region}-interval`,
        title: "95 %",
        text: (row) =>
          intervalOf(cell, question(row))
            ?.map((v) => significant(v))
            .join(" … ") ?? "–",
      });
    if (METRICS.some((row) => floorOf(cell, question(row)) > 0))
      columns.push(
        numberColumn(`${region}-floor`, "noise floor", (row) => floorOf(cell, question(row)), {
          note: "what the reference's own noise adds",
        }),
      );
    if (cell.matched)
      columns.push(
        numberColumn(`${region}-matched`, "own bounces", (row) => errorOf(cell, question(row, "matched")), {
          note: "against the truth with the technique's number of bounces",
        }),
      );
  }
  return new Table({caption: "Errors", columns, rows: METRICS, rowKey: (row) => row.key, filterable: false}).element;
}

function pairsTable(caption, pairs) {
  const rows = pairs.filter(([, value]) => (value ?? "–") !== "–"); // not measured
  return (
    rows.length > 0 &&
    new Table({
      caption,
      rows,
      rowKey: (row) => row[0],
      filterable: false,
      columns: [
        {key: "name", title: "quantity", left: true, text: (row) => row[0]},
        {key: "value", title: "value", text: (row) => String(row[1])},
      ],
    }).element
  );
}

function costPairs(cell) {
  const {cost, counters = {}} = cell;
  const number = (value) => significant(value ?? NaN);
  const interval = (low, high) => (low === undefined ? "" : ` (${significant(low)} … ${significant(high)})`);
  return [
    ["frame ms", cost && number(cost.frame_ms) + interval(cost.frame_ms_low, cost.frame_ms_high)],
    ["× plain frame", cost && number(cost.ratio) + interval(cost.ratio_low, cost.ratio_high)],
    [
      "frame ms: 50 %, 95 %, 99 %, worst",
      cost?.peaks &&
        [cost.peaks.p50, cost.peaks.p95, cost.peaks.p99, cost.peaks.worst].map((v) => significant(v)).join(", "),
    ],
    ["captures ms, by bounce", cost && cost.capture_ms.map((v) => significant(v)).join(" + ")],
    ["final image ms", number(cost?.final_ms)],
    ["renders a frame", cost?.renders_formula],
    ["flicker, whole image", number(cell.flicker?.whole)],
    ["flicker, mask", number(cell.flicker?.mask)],
    ["mean age of faces, frames", significant(faceAgeOf(cell))],
    ...Object.entries(counters).map(([name, value]) => [name.replaceAll("_", " "), value.toLocaleString("en-US")]),
  ];
}

const share = {
  key: "share",
  title: "share",
  note: "of the picture's squared error",
  value: (row) => row.share,
  text: (row) => percent(row.share),
};
const regionColumns = [
  numberColumn("pixels", "pixels", (row) => row.pixels, {
    text: (row) => String(row.pixels),
    cell: (row) => String(row.pixels),
  }),
  share,
  numberColumn("flip_hdr", "FLIP-HDR", (row) => row.flip_hdr ?? NaN),
  numberColumn("relmse", "relMSE", (row) => row.relmse ?? NaN),
  numberColumn("bias", "bias", (row) => row.bias ?? NaN),
];

const textColumn = (key) => ({key, title: key, left: true, text: (row) => row[key] ?? ""});

// What each object or material adds to the error, the largest share first.
function shareTable(what, rows, columns) {
  if (!rows?.length) return null;
  return new Table({
    caption: `Errors by ${what}`,
    columns,
    rows,
    rowKey: (row) => row[what],
    sort: {key: "share", descending: true},
    filterable: rows.length > 12,
  }).element;
}

const objectTable = (cell) =>
  shareTable("object", cell.objects, [
    textColumn("object"),
    textColumn("material"),
    ...regionColumns,
    {key: "probe", title: "probe", text: (row) => String(row.probe ?? "–")},
    numberColumn("distance", "distance m", (row) => row.probe_distance ?? NaN, {
      note: "from the surface to its probe, mean",
    }),
    numberColumn("roughness", "roughness", (row) => row.roughness ?? NaN),
  ]);

const materialTable = (cell) => shareTable("material", cell.materials, [textColumn("material"), ...regionColumns]);

export function cellDetails(cell, viewer, pictures) {
  const crops = element("div");
  fillCrops(crops, cell, pictures, (cluster) => viewer.showRectangle(cluster)).catch(() => crops.replaceChildren());
  return [
    element("h3", {}, `${cell.sequence.label}, frame ${cell.frame}`),
    element(
      "p",
      {class: "note"},
      element("a", {href: linkTo(cell), class: "permalink"}, "Link to this cell"),
      " · ",
      element("code", {}, cell.shortKey),
    ),
    viewer.element,
    crops,
    element(
      "div",
      {class: cell.matched || cell.intervals ? "numbers" : "numbers columns"},
      errorTable(cell),
      pairsTable("Cost and work", costPairs(cell)),
    ),
    objectTable(cell),
    materialTable(cell),
  ];
}
