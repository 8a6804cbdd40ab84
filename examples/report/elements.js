// The elements, tables and images of every page.

const page = document.getElementById("page");

function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}
const paragraph = (text, className = "") => element("p", { className }, text);

function table(head, rows, caption) {
  const row = (cells, kind) => element("tr", {}, ...cells.map((cell) => element(kind, {}, cell)));
  return element("table", {}, ...(caption ? [element("caption", {}, caption)] : []), element("thead", {}, row(head, "th")),
    element("tbody", {}, ...rows.map((cells) => row(cells, "td"))));
}

// Hides Plot's names of marks from screen readers; data-mark keeps them for style and tests.
function without_names(image) {
  for (const mark of image.querySelectorAll("g[aria-label]")) {
    mark.dataset.mark = mark.getAttribute("aria-label");
    mark.removeAttribute("aria-label");
  }
  return image;
}
