// Two runs: what changed from the one before to the page's own.
import {choice, element, section} from "./dom.js";
import {decode, percent, significant, signed} from "./numbers.js";
import {linkTo} from "./places.js";
import {Table} from "./table.js";

const QUANTITIES = [
  ["flip_hdr", "FLIP-HDR"],
  ["relmse", "relMSE"],
  ["ssim", "SSIM"],
  ["frame_ms", "frame ms"],
  ["ratio", "× plain"],
];

function rowsOf(comparison, model, quantity) {
  const cells = new Map(
    model.views.flatMap((v) => v.sequences.flatMap((s) => s.cells)).map((cell) => [cell.index, cell]),
  );
  return comparison.cells
    .filter((c) => quantity in c.values)
    .map((c) => {
      const value = c.values[quantity],
        before = decode(value.before),
        after = decode(value.after);
      return {
        cell: cells.get(c.after),
        before,
        after,
        difference: after - before,
        relative: (after - before) / Math.abs(before),
        change: value.change,
        beforeInterval: value.beforeInterval,
        afterInterval: value.afterInterval,
      };
    });
}

const withInterval = (value, interval) =>
  significant(value) + (interval ? ` (${interval.map((v) => significant(decode(v))).join(" … ")})` : "");

function columnsOf() {
  const text = (key, title, of) => ({key, title, left: true, text: of});
  return [
    {
      ...text("change", "verdict", (row) => row.change),
      cell: (row) => element("span", {class: `change ${row.change.replaceAll(" ", "-")}`}, row.change),
    },
    text("scene", "scene", (row) => row.cell.scene),
    text("frame", "frame", (row) => String(row.cell.frame)),
    {
      ...text("technique", "technique", (row) => row.cell.sequence.label),
      cell: (row) => element("a", {href: linkTo(row.cell)}, row.cell.sequence.label),
    },
    {
      key: "before",
      title: "before",
      value: (row) => row.before,
      text: (row) => withInterval(row.before, row.beforeInterval),
    },
    {
      key: "after",
      title: "after",
      value: (row) => row.after,
      text: (row) => withInterval(row.after, row.afterInterval),
    },
    {key: "difference", title: "difference", value: (row) => row.difference, text: (row) => signed(row.difference)},
    {key: "relative", title: "relative", value: (row) => Math.abs(row.relative), text: (row) => percent(row.relative)},
  ];
}

function countText(rows) {
  const count = (change) => rows.filter((row) => row.change === change).length;
  return ["better", "worse", "equal", "below the floor", "changed"].map((change) => `${count(change)} ${change}`).join(", ");
}

export function comparisonSection(comparison, model) {
  const place = element("div"),
    counts = element("p", {class: "counts"});
  const known = QUANTITIES.filter(([key]) => comparison.cells.some((c) => key in c.values));
  const fill = (quantity) => {
    const rows = rowsOf(comparison, model, quantity);
    counts.textContent = `${rows.length} cells: ${countText(rows)}.`;
    place.replaceChildren(
      new Table({
        caption: "Before and after",
        columns: columnsOf(),
        rows,
        rowKey: (row) => row.cell.shortKey,
        hint: "words, change=worse, after<0.1",
        sort: {key: "relative", descending: true},
      }).element,
    );
  };
  if (known.length) fill(known[0][0]);
  const {onlyBefore, onlyAfter} = comparison;
  const note = "equal: the same, or the difference is within its 95 % interval (paired where both runs have the same reference); below the floor: so, and neither is clear of the reference's own noise; changed: not the same, and no interval is known. Costs stand with the first frame of a technique.";
  return section(
    "comparison",
    "Before and after",
    known.length
      ? choice(
          "Value",
          known.map(([value, title]) => ({value, title})),
          known[0][0],
          fill,
        )
      : element("p", {}, "The runs have no cell in common."),
    counts,
    element(
      "p",
      {class: "note"},
      [
        note,
        onlyBefore.length && `${onlyBefore.length} cells are in the earlier run only.`,
        onlyAfter.length && `${onlyAfter.length} cells are in the later run only.`,
      ]
        .filter(Boolean)
        .join(" "),
    ),
    place,
  );
}
