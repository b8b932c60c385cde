// Tables that sort by a click on a column's head and filter by what is typed: words, and comparisons such as
// "resolution=128" or "flip_hdr<0.02".
import {element, freshId} from "./dom.js";

// "name<value" and the like as a test of a row; other words are searched in the row's text.
function testOf(word, columns) {
  const comparison = /^([^<>=!]+)(<=|>=|!=|<|>|=)(.+)$/.exec(word);
  const named =
    comparison &&
    columns.find((column) =>
      [column.key, column.title].some((name) => name.toLowerCase() === comparison[1].toLowerCase()),
    );
  if (!named) return (row) => columns.some((column) => column.text(row).toLowerCase().includes(word.toLowerCase()));
  const [, , operator, text] = comparison;
  const limit = Number(text);
  const value = (row) => named.value(row);
  switch (operator) {
    case "<":
      return (row) => value(row) < limit;
    case ">":
      return (row) => value(row) > limit;
    case "<=":
      return (row) => value(row) <= limit;
    case ">=":
      return (row) => value(row) >= limit;
    case "!=":
      return (row) => named.text(row) !== text;
    default:
      return (row) => named.text(row) === text || value(row) === limit;
  }
}

const classOf = (column) => [column.left && "left", column.wrap && "wrap"].filter(Boolean).join(" ") || undefined;

function compared(a, b) {
  if (typeof a === "number" && typeof b === "number") {
    if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
    return a - b;
  }
  const [x, y] = [Number(a), Number(b)];
  return Number.isNaN(x) || Number.isNaN(y) ? String(a).localeCompare(String(b)) : x - y;
}

// columns: [{key, title, text(row), value(row)?, left?, wrap?, cell(row)?, note?}]: `value` sorts and is compared with, `cell` is shown.
export class Table {
  constructor({caption, columns, rows, rowKey = () => "", filterable = true, hint = "words", sort = null}) {
    this.columns = columns.map((column) => ({value: column.text, cell: column.text, ...column}));
    this.rows = rows;
    this.rowKey = rowKey;
    this.sort = sort;
    this.filter = "";
    this.body = element("tbody");
    this.count = element("output", {class: "count"});
    this.head = element(
      "tr",
      {},
      this.columns.map((column) => this.headOf(column)),
    );
    const table = element("table", {}, element("caption", {}, caption), element("thead", {}, this.head), this.body);
    this.element = element(
      "div",
      {class: "table"},
      filterable && rows.length > 5 && this.filterOf(caption, hint),
      element("div", {class: "scroll", tabindex: 0, role: "region", "aria-label": caption}, table),
    );
    this.fill();
  }

  filterOf(caption, hint) {
    const id = freshId("filter");
    return element(
      "div",
      {class: "filter"},
      element("label", {for: id}, "Filter"),
      element("input", {
        id,
        type: "search",
        placeholder: hint,
        "aria-label": `Filter: ${caption}`,
        oninput: (event) => {
          this.filter = event.target.value;
          this.fill();
        },
      }),
      this.count,
    );
  }

  headOf(column) {
    return element(
      "th",
      {scope: "col", class: classOf(column), "data-key": column.key},
      element("button", {type: "button", title: column.note, onclick: () => this.sortBy(column.key)}, column.title),
    );
  }

  sortBy(key) {
    this.sort = {key, descending: this.sort?.key === key && !this.sort.descending};
    this.fill();
  }

  shownRows() {
    const tests = this.filter
      .split(/\s+/)
      .filter(Boolean)
      .map((word) => testOf(word, this.columns));
    const rows = this.rows.filter((row) => tests.every((test) => test(row)));
    const column = this.columns.find((c) => c.key === this.sort?.key);
    if (!column) return rows;
    const sign = this.sort.descending ? -1 : 1;
    return rows
      .map((row, i) => [row, i])
      .sort(([a, i], [b, j]) => sign * compared(column.value(a), column.value(b)) || i - j)
      .map(([row]) => row);
  }

  fill() {
    for (const th of this.head.children) {
      if (th.dataset.key === this.sort?.key)
        th.setAttribute("aria-sort", this.sort.descending ? "descending" : "ascending");
      else th.removeAttribute("aria-sort");
    }
    const rows = this.shownRows();
    this.body.replaceChildren(
      ...rows.map((row) =>
        element(
          "tr",
          {"data-key": this.rowKey(row)},
          this.columns.map((column) => element("td", {class: classOf(column)}, column.cell(row))),
        ),
      ),
    );
    if (!rows.length)
      this.body.append(
        element("tr", {}, element("td", {class: "left", colspan: this.columns.length}, "No row passes the filter.")),
      );
    this.count.textContent =
      rows.length < this.rows.length ? `${rows.length} of ${this.rows.length}` : `${rows.length} rows`;
    this.mark(this.marked);
  }

  // Shows which row is open elsewhere on the page.
  mark(key) {
    this.marked = key;
    for (const tr of this.body.children) {
      if (key !== undefined && tr.dataset.key === key) tr.setAttribute("aria-current", "true");
      else tr.removeAttribute("aria-current");
    }
  }
}
