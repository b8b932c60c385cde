// What the page shows, in its address: #cell=KEY&mode=split. KEY is the cell's key, in full or with the varying axes only.

const listeners = [];
export const onPlace = (listener) => listeners.push(listener);

export function readPlace() {
  return Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
}

export function linkTo(cell, more = {}) {
  return `#${new URLSearchParams({cell: cell.shortKey, ...more})}`;
}

// Changes the address without a new entry in the history.
export function replacePlace(cell, more) {
  history.replaceState(null, "", linkTo(cell, more));
}

export function findCell(model, key) {
  for (const view of model.views)
    for (const sequence of view.sequences)
      for (const cell of sequence.cells) if (cell.shortKey === key || cell.key === key) return cell;
  return undefined;
}

globalThis.addEventListener("hashchange", () => listeners.forEach((listener) => listener(readPlace())));
