// Elements of the page. Text is always set as text: names of scenes and materials can't become markup.

// element("a", {href: "#x", class: "quiet"}, "text", child): attributes that are false or undefined are left out, `on...`
// are listeners.
export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false || value === null) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

let lastId = 0;
export const freshId = (prefix) => `${prefix}-${++lastId}`;

// A select with its label. options: [{value, title}].
export function choice(label, options, value, onChange) {
  const select = element(
    "select",
    {onchange: () => onChange(select.value)},
    options.map((option) => element("option", {value: option.value, selected: option.value === value}, option.title)),
  );
  return element("label", {class: "choice"}, label, select);
}

export function section(id, title, ...children) {
  return element(
    "section",
    {id, "aria-labelledby": `${id}-title`},
    element("h2", {id: `${id}-title`}, title),
    ...children,
  );
}

// Puts new children into an element without a jump of the page: its height is kept while it is empty.
export function refill(node, ...children) {
  node.style.minHeight = `${node.offsetHeight}px`;
  node.replaceChildren(...children.flat().filter(Boolean));
  node.style.minHeight = "";
}

// What a screen reader should say.
export function announce(text) {
  document.getElementById("status").textContent = text;
}
