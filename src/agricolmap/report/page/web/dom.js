// Elements without markup: all text is set as text, so that a name is never taken for a tag.

const SVG = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) {
      element.addEventListener(name.slice(2), value);
    } else {
      element.setAttribute(name, value === true ? "" : value);
    }
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

export function el(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

export function svg(tag, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

/** A section with its heading, listed in the page's contents under `short`. */
export function section(id, title, short, ...children) {
  const heading = el("h2", { id: `${id}-title` }, title);
  const part = el("section", { id, "aria-labelledby": `${id}-title` }, heading, ...children);
  part.dataset.short = short;
  return part;
}

/** Radio buttons that look like one switch. `choices`: [value, label]. */
export function choice(name, legend, choices, chosen, onchange) {
  const buttons = choices.map(([value, label]) =>
    el("label", {},
      el("input", { type: "radio", name, value, checked: value === chosen,
        onchange: () => onchange(value) }),
      el("span", {}, label)));
  return el("fieldset", { class: "choice" }, el("legend", {}, legend), ...buttons);
}

export function check(label, checked, onchange) {
  const input = el("input", { type: "checkbox", checked,
    onchange: (event) => onchange(event.target.checked) });
  return el("label", { class: "check" }, input, el("span", {}, label));
}

export function button(label, onclick, attributes = {}) {
  return el("button", { type: "button", onclick, ...attributes }, label);
}

/** A table of rows of cells; the first cell of each row is its head. */
export function table(caption, heads, rows) {
  return el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": caption },
    el("table", {},
      el("caption", {}, caption),
      heads.length ? el("thead", {}, el("tr", {},
        ...heads.map((head) => el("th", { scope: "col" }, head)))) : null,
      el("tbody", {}, ...rows.map((row) =>
        el("tr", {}, ...row.map((cell, i) =>
          i === 0 ? el("th", { scope: "row" }, cell) : el("td", {}, cell)))))));
}

/** What the page's style says a colour is, for canvases. */
export function styleColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
