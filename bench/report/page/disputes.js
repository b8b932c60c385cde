// Pairs of cells that FLIP-HDR and relMSE order oppositely, as pictures: what each metric finds worse.
import {element, refill, section} from "./dom.js";
import {errorOf} from "./model.js";
import {significant} from "./numbers.js";
import {developed, difference} from "./pictures.js";
import {linkTo} from "./places.js";

function shown(picture, title) {
  const canvas = element("canvas", {width: picture.width, height: picture.height, role: "img", "aria-label": title});
  canvas.getContext("2d").drawImage(picture, 0, 0);
  return element("figure", {}, canvas, element("figcaption", {}, title));
}

// One row of pictures: the image, FLIP's map and the difference that relMSE squares.
async function fillRow(place, cell, pictures) {
  const {rendered, reference, flip} = cell.pictures ?? {};
  if (!pictures.has(rendered) || !pictures.has(reference)) {
    place.replaceChildren(element("p", {class: "note"}, "The run kept no picture of this frame."));
    return;
  }
  const [a, b] = [await pictures.hdr(rendered), await pictures.hdr(reference)];
  refill(
    place,
    shown(developed(a, 0), "rendered"),
    pictures.has(flip) && shown(await pictures.png(flip), "FLIP map"),
    shown(difference(a, b, 0), "|rendered − reference|"),
  );
}

function numbersOf(cell, hasMask) {
  const question = {region: hasMask ? "mask" : "whole", truth: "converged"};
  const text = (metric, title) => `${title} ${significant(errorOf(cell, {...question, metric}))}`;
  return `${text("flip_hdr", "FLIP-HDR")}, ${text("relmse", "relMSE")}`;
}

function cellRow(cell, better, factor, pictures) {
  const row = element("div", {class: "dispute-row"});
  fillRow(row, cell, pictures).catch(() => row.replaceChildren());
  return [
    element(
      "p",
      {},
      element("a", {href: linkTo(cell)}, cell.sequence.label),
      `: ${numbersOf(cell, Boolean(cell.mask_metrics))}; better by ${better}, factor ${significant(factor)}`,
    ),
    row,
  ];
}

// disputes: {count, shown: [{byFlip, byRelmse, flipFactor, relmseFactor}]}, cells as indices.
export function disputesSection(disputes, model, pictures) {
  if (!disputes?.shown.length) return false;
  const cells = new Map(
    model.views.flatMap((v) => v.sequences.flatMap((s) => s.cells)).map((cell) => [cell.index, cell]),
  );
  return section(
    "disputes",
    "Where the metrics disagree",
    element(
      "p",
      {class: "note"},
      `FLIP-HDR and relMSE order ${disputes.count} ${disputes.count === 1 ? "pair" : "pairs"} of techniques oppositely. FLIP sees what an eye sees of an error, relMSE its energy: look at both before believing one.`,
    ),
    disputes.shown.map(({byFlip, byRelmse, flipFactor, relmseFactor}) => {
      const [first, second] = [cells.get(byFlip), cells.get(byRelmse)];
      return element(
        "article",
        {class: "dispute"},
        element("h3", {}, `${first.sequence.view.title}, frame ${first.frame}`),
        cellRow(first, "FLIP-HDR", flipFactor, pictures),
        cellRow(second, "relMSE", relmseFactor, pictures),
      );
    }),
  );
}
