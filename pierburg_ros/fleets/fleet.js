"use strict";
// Sorts and filters the table of units, and opens a unit: its courses as plots, its recordings as links. What only an
// open unit needs waits until the table is shown: the plotting library, and of the details, a line a unit in the order
// of their rank, the line of this unit.
(() => {
  const table = document.getElementById("fleet"), body = table.tBodies[0], rows = [...body.rows];
  const root = document.documentElement, colour = (name) => getComputedStyle(root).getPropertyValue(`--${name}`).trim();
  const filter = document.getElementById("filter"), kind = document.getElementById("kind"), shown = document.getElementById("shown");
  const texts = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));
  let details = null;

  function element(name, text, attributes = {}) {
    const made = document.createElement(name);
    if (text !== undefined) made.textContent = text;
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  }

  function close(row) {
    if (!row.nextElementSibling || row.nextElementSibling.dataset.detail === undefined) return;
    for (const plot of row.nextElementSibling.querySelectorAll(".drawing")) Plotly.purge(plot);
    row.nextElementSibling.remove();
    row.querySelector("[data-unit]").setAttribute("aria-expanded", "false");
  }

  function sort(button) {
    const header = button.closest("th"), place = header.cellIndex, number = button.dataset.sort === "number";
    const down = header.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    header.setAttribute("aria-sort", down ? "descending" : "ascending");
    rows.forEach(close);
    const key = new Map(rows.map((row) => [row, number ? +row.cells[place].textContent : row.cells[place].textContent]));
    const compare = number ? (a, b) => a - b : new Intl.Collator("en", { numeric: true }).compare;
    rows.sort((a, b) => (down ? -1 : 1) * compare(key.get(a), key.get(b)));
    body.append(...rows);
  }

  function narrow() {
    const wanted = filter.value.toLowerCase().trim();
    let count = 0;
    for (const row of rows) {
      const fits = (!wanted || texts.get(row).includes(wanted)) && (!kind.value || row.dataset.kind === kind.value);
      if (!fits) close(row);
      row.hidden = !fits;
      count += fits;
    }
    shown.textContent = `${count} units`;
  }

  function draw(div, course) {
    const axis = { gridcolor: colour("line"), linecolor: colour("line"), zeroline: false };
    const sure = course.time.map((_, i) => i).filter((i) => !course.limited[i]), at = (values) => sure.map((i) => values[i]);
    const limited = course.time.map((_, i) => i).filter((i) => course.limited[i]);
    const data = [
      { type: "scatter", mode: "markers", name: "measured", x: at(course.time), y: at(course.value), error_y: { type: "data", array: at(course.reach), thickness: 1, width: 2 }, marker: { color: colour("final"), size: 6 } },
      { type: "scatter", mode: "markers", name: "not above", x: limited.map((i) => course.time[i]), y: limited.map((i) => 2 * course.value[i]), marker: { color: colour("soft"), size: 8, symbol: "triangle-down-open" } },
      { type: "scatter", mode: "lines", name: "line", x: course.time, y: course.line, line: { color: colour("nominal"), width: 1.5 } },
    ].filter((trace) => trace.y.length);
    const shapes = course.limit === null ? [] : [{ type: "line", xref: "paper", x0: 0, x1: 1, y0: course.limit, y1: course.limit, line: { color: colour("red"), dash: "dot", width: 1.5 } }];
    return Plotly.newPlot(div, data, { width: div.clientWidth, height: 260, showlegend: false, shapes, margin: { t: 10, r: 10, b: 40, l: 66 }, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { family: "system-ui, sans-serif", color: colour("ink"), size: 12 }, xaxis: { ...axis, type: "date" }, yaxis: { ...axis, title: { text: `${course.name} [${course.unit}]` }, automargin: true } }, { displayModeBar: false });
  }

  function prepare() {
    if (details !== null) return;
    details = document.getElementById("details").textContent.split("\n");
    document.body.append(element("script", document.getElementById("library").textContent));
  }

  function open(row, button) {
    prepare();
    const own = JSON.parse(details[row.cells[0].textContent - 1]), line = element("tr", undefined, { "data-detail": "" });
    const cell = element("td", undefined, { colspan: "8" }), grid = element("div", undefined, { class: "grid" });
    line.append(cell);
    row.after(line);
    button.setAttribute("aria-expanded", "true");
    cell.append(grid);
    for (const course of own.courses) {
      const figure = element("figure", undefined, { class: "plot" }), caption = `${course.name}: ${course.said}`;
      const div = element("div", undefined, { class: "drawing", role: "img", "aria-label": `${caption}, over time` });
      div.style.height = "260px";
      figure.append(element("figcaption", caption), div);
      grid.append(figure);
      draw(div, course);
    }
    const inner = element("table"), head = element("tr");
    inner.append(element("caption", `Recordings of ${button.dataset.unit}`, { class: "hidden" }));
    for (const name of ["time", "recording", "verdict", "named"]) head.append(element("th", name, { scope: "col" }));
    const top = element("thead"), rest = element("tbody");
    top.append(head);
    for (const [time, name, verdict, named, report] of own.recordings) {
      const each = element("tr"), link = element("td");
      link.append(report ? element("a", name, { href: report }) : name);
      each.append(element("td", time), link, element("td", verdict), element("td", named));
      rest.append(each);
    }
    inner.append(top, rest);
    cell.append(inner);
  }

  table.addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    if (button.dataset.sort) sort(button);
    if (button.dataset.unit !== undefined) {
      const row = button.closest("tr");
      if (button.getAttribute("aria-expanded") === "true") close(row); else open(row, button);
    }
  });
  window.addEventListener("load", () => (window.requestIdleCallback || setTimeout)(prepare));
  filter.addEventListener("input", narrow);
  kind.addEventListener("change", narrow);
})();
