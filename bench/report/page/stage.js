// A canvas that shows part of a picture. Stages that share a lens show the same part.
import {element} from "./dom.js";

const MAX_ZOOM = 32;

// Which part of a picture is seen: zoom 1 shows all of it; centre in [0, 1].
export class Lens {
  constructor(onChange) {
    this.onChange = onChange;
    this.reset(false);
  }

  reset(notify = true) {
    Object.assign(this, {zoom: 1, x: 0.5, y: 0.5});
    if (notify) this.onChange();
  }

  // Around a point of the stage, both in [0, 1].
  zoomBy(factor, atX = 0.5, atY = 0.5) {
    const zoom = Math.min(Math.max(this.zoom * factor, 1), MAX_ZOOM);
    const shift = 1 / this.zoom - 1 / zoom;
    this.set(zoom, this.x + (atX - 0.5) * shift, this.y + (atY - 0.5) * shift);
  }

  panBy(dx, dy) {
    this.set(this.zoom, this.x - dx / this.zoom, this.y - dy / this.zoom);
  }

  // A rectangle of the picture, all in [0, 1], with some surroundings.
  showRectangle(x, y, width, height) {
    this.set(Math.min(Math.max(0.5 / Math.max(width, height), 1), MAX_ZOOM), x + width / 2, y + height / 2);
  }

  set(zoom, x, y) {
    const inside = (v) => Math.min(Math.max(v, 0.5 / zoom), 1 - 0.5 / zoom);
    Object.assign(this, {zoom, x: inside(x), y: inside(y)});
    this.onChange();
  }
}

export class Stage {
  constructor(lens) {
    this.lens = lens;
    this.canvas = element("canvas", {role: "img", "aria-label": "picture"});
    this.label = element("span", {class: "label"});
    this.element = element("div", {class: "stage"}, this.canvas, this.label);
    this.canvas.addEventListener("wheel", (event) => this.wheel(event), {passive: false});
    this.canvas.addEventListener("pointerdown", (event) => this.grab(event));
    this.canvas.addEventListener("dblclick", (event) => this.lens.zoomBy(2, ...this.placeOf(event)));
  }

  // Of the stage, in [0, 1].
  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  }

  // Of the picture, in pixels.
  pixelOf(event, width, height) {
    const [x, y] = this.placeOf(event);
    const at = (place, centre, size) =>
      Math.min(Math.max(Math.floor((centre + (place - 0.5) / this.lens.zoom) * size), 0), size - 1);
    return [at(x, this.lens.x, width), at(y, this.lens.y, height)];
  }

  // Only with Ctrl (or two fingers on a touchpad): the wheel alone scrolls the page.
  wheel(event) {
    if (!event.ctrlKey) return;
    event.preventDefault();
    this.lens.zoomBy(2 ** (-event.deltaY / 200), ...this.placeOf(event));
  }

  grab(event) {
    this.canvas.setPointerCapture(event.pointerId);
    let [x, y] = this.placeOf(event);
    const movesDivider = this.onDivider && Math.abs(x - this.onDivider.position()) * this.canvas.clientWidth < 16;
    const move = (moved) => {
      const [newX, newY] = this.placeOf(moved);
      if (movesDivider) this.onDivider.move(Math.min(Math.max(newX, 0), 1));
      else this.lens.panBy(newX - x, newY - y);
      [x, y] = [newX, newY];
    };
    this.canvas.addEventListener("pointermove", move);
    const release = () => this.canvas.removeEventListener("pointermove", move);
    this.canvas.addEventListener("pointerup", release, {once: true});
    this.canvas.addEventListener("pointercancel", release, {once: true});
  }

  // parts: [{picture, from, to}], canvases of one size, each shown between two fractions of the width.
  draw(parts) {
    const ratio = globalThis.devicePixelRatio || 1;
    const width = Math.round(this.canvas.clientWidth * ratio),
      height = Math.round(this.canvas.clientHeight * ratio);
    if (!width || !height) return;
    Object.assign(this.canvas, {width, height});
    const context = this.canvas.getContext("2d");
    for (const {picture, from, to} of parts) this.drawPart(context, picture, from * width, (to - from) * width);
  }

  drawPart(context, picture, left, partWidth) {
    const {width, height} = this.canvas,
      {zoom, x, y} = this.lens;
    context.save();
    context.beginPath();
    context.rect(left, 0, partWidth, height);
    context.clip();
    context.imageSmoothingEnabled = (zoom * width) / picture.width < 1;
    context.drawImage(
      picture,
      (x - 0.5 / zoom) * picture.width,
      (y - 0.5 / zoom) * picture.height,
      picture.width / zoom,
      picture.height / zoom,
      0,
      0,
      width,
      height,
    );
    context.restore();
  }
}
