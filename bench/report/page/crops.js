// The largest clusters of error in a picture, cut out of reference, rendered picture and FLIP map.
import {element} from "./dom.js";
import {percent} from "./numbers.js";
import {developed} from "./pictures.js";

const SIZE = 132; // CSS pixels of a crop's longer side
const MARGIN = 0.35; // of the cluster's size, around it

function cropBox({x, y, width, height}, picture) {
  const side = Math.min(Math.max(width, height, 8) * (1 + 2 * MARGIN), picture.width, picture.height);
  const inside = (centre, size) => Math.min(Math.max(centre - side / 2, 0), size - side);
  return {x: inside(x + width / 2, picture.width), y: inside(y + height / 2, picture.height), side};
}

function crop(picture, box, title) {
  const canvas = element("canvas", {
    width: 2 * SIZE,
    height: 2 * SIZE,
    role: "img",
    "aria-label": title,
    title,
    style: `width: ${SIZE}px; height: ${SIZE}px`,
  });
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.drawImage(picture, box.x, box.y, box.side, box.side, 0, 0, 2 * SIZE, 2 * SIZE);
  return canvas;
}

// Fills `place` when the pictures are there. onShow(cluster): it should be seen larger.
export async function fillCrops(place, cell, pictures, onShow) {
  const {rendered, reference, flip} = cell.pictures ?? {};
  if (!cell.clusters?.length || !pictures.has(rendered) || !pictures.has(reference)) return;
  const [a, b, map] = [
    await pictures.hdr(reference),
    await pictures.hdr(rendered),
    pictures.has(flip) ? await pictures.png(flip) : null,
  ];
  const layers = [["reference", developed(a, 0)], ["rendered", developed(b, 0)], ...(map ? [["FLIP map", map]] : [])];
  place.replaceChildren(
    element("h4", {}, "Where the error sits together"),
    element(
      "div",
      {class: "crops"},
      cell.clusters.map((cluster) => {
        const box = cropBox(cluster, a);
        return element(
          "figure",
          {},
          element(
            "button",
            {type: "button", onclick: () => onShow(cluster), "aria-label": `show ${cluster.object} in the viewer`},
            layers.map(([title, picture]) => crop(picture, box, title)),
          ),
          element(
            "figcaption",
            {},
            `${cluster.object}: ${percent(cluster.share)} of the squared error in ${cluster.pixels} pixels`,
          ),
        );
      }),
    ),
  );
}
