// Elements in one call.

/** element("p", {class: "note"}, "text", child, ...): functions among the attributes listen to events of their names. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value);
    else if (value !== null && value !== undefined && value !== false) made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

/** A labelled choice among {key, title}; `changed` gets the chosen one. */
export function choice(label, options, chosen, changed) {
  const select = element("select", {change: () => changed(options[select.selectedIndex])},
                         options.map((option) => element("option", {selected: option === chosen}, option.title)));
  return element("label", {class: "choice"}, `${label} `, select);
}
