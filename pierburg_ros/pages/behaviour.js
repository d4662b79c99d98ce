"use strict";
// Draws the plots of a page from the JSON beside them: as fine as the window of time shown allows, in the page's
// colours, with a legend of buttons, and with zoom and switches by click and by keyboard.
(() => {
  const BUCKETS = 700; // of a plot; the lowest and the highest sample of each are drawn
  const root = document.documentElement;
  const content = (element) => JSON.parse(element.textContent);
  const stored = content(document.getElementById("signals"));
  const plots = new Map();

  function bytes(text) {
    const raw = atob(text);
    const out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
    return out.buffer;
  }

  const cache = new Map();
  function signal(key) {
    if (!cache.has(key)) {
      const { kind, scale, data } = stored[key];
      const raw = kind === "f4" ? new Float32Array(bytes(data)) : new Int16Array(bytes(data));
      cache.set(key, kind === "f4" ? raw : Float64Array.from(raw, (value) => scale * value));
    }
    return cache.get(key);
  }

  const pauses = new Map();
  function pause(key) { // an interval that is longer than this is a gap
    if (!pauses.has(key)) {
      const time = signal(key);
      const steps = Float32Array.from(time.subarray(1), (value, i) => value - time[i]).sort();
      pauses.set(key, 5 * (steps[steps.length >> 1] || 1));
    }
    return pauses.get(key);
  }

  function place(time, value) { // the first sample not before `value`
    let low = 0, high = time.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (time[middle] < value) low = middle + 1; else high = middle;
    }
    return low;
  }

  // The samples of a curve within a window of time: all, or the lowest and the highest of each bucket.
  function sampled(meta, window) {
    const time = signal(meta.time), plus = signal(meta.plus), minus = meta.minus && signal(meta.minus);
    const value = minus ? (i) => plus[i] - minus[i] : (i) => plus[i];
    const from = Math.max(place(time, window[0]) - 1, 0), to = Math.min(place(time, window[1]) + 1, time.length);
    const x = [], y = [], longest = pause(meta.time);
    const add = (i, last) => {
      if (last !== null && time[i] - time[last] > Math.max(longest, 3 * (time[to - 1] - time[from]) / BUCKETS)) { x.push(time[i]); y.push(null); }
      x.push(time[i]); y.push(value(i));
      return i;
    };
    let last = null;
    const each = Math.max(1, Math.ceil((to - from) / BUCKETS));
    if (each <= 2) { for (let i = from; i < to; i++) last = add(i, last); return { x, y }; }
    for (let begin = from; begin < to; begin += each) {
      let low = begin, high = begin;
      for (let i = begin + 1; i < Math.min(begin + each, to); i++) {
        if (value(i) < value(low)) low = i;
        if (value(i) > value(high)) high = i;
      }
      last = add(Math.min(low, high), last);
      if (low !== high) last = add(Math.max(low, high), last);
    }
    return { x, y };
  }

  const colour = (name) => getComputedStyle(root).getPropertyValue(`--${name}`).trim();
  const axes = (layout) => Object.keys(layout).filter((key) => /^[xy]axis\d*$/.test(key));

  function styled(plot) { // layout in the page's colours, as wide as the page
    const layout = plot.layout, ink = colour("ink"), line = colour("line"), narrow = plot.div.clientWidth < 560;
    const shown = { ...layout, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", showlegend: false,
      font: { family: "system-ui, sans-serif", size: narrow ? 11 : 12, color: ink }, width: plot.div.clientWidth,
      height: plot.div.clientHeight, modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("soft"), activecolor: ink }, hoverlabel: { bgcolor: colour("card"), font: { color: ink } },
      margin: { t: 26, b: 42, l: narrow ? 54 : 66, r: narrow ? 8 : 16, ...layout.margin } };
    for (const name of axes(layout)) {
      const axis = { gridcolor: line, zerolinecolor: line, linecolor: line, automargin: true, ...layout[name] };
      if (narrow && axis.title) axis.title = { ...axis.title, font: { size: 10 } };
      shown[name] = axis;
    }
    return shown;
  }

  function traces(plot) {
    return plot.data.map((trace) => {
      const meta = trace.meta || {};
      const drawn = { ...trace };
      if (meta.colour) {
        if (trace.line || (trace.mode || "lines").includes("lines")) drawn.line = { ...trace.line, color: colour(meta.colour) };
        if (trace.marker || (trace.mode || "").includes("markers")) drawn.marker = { ...trace.marker, color: colour(meta.colour) };
      }
      if (meta.time) Object.assign(drawn, trace.visible === false ? { x: [], y: [] } : sampled(meta, plot.window));
      return drawn;
    });
  }

  function draw(plot) {
    const layout = styled(plot);
    if (plot.whole) for (const name of axes(layout)) if (name.startsWith("x")) layout[name] = { ...layout[name], range: plot.window.slice(), autorange: false };
    return Plotly.react(plot.div, traces(plot), layout, { displaylogo: false, displayModeBar: plot.div.clientWidth < 560 ? false : "hover", doubleClick: plot.whole ? false : "reset+autosize", modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "resetScale2d"] });
  }

  function zoom(plot, from, to) {
    plot.window = [from, to];
    return draw(plot);
  }

  function legend(plot) { // a button for each group of curves
    const list = document.createElement("ul");
    list.className = "legend";
    list.setAttribute("aria-label", "curves, press to hide or show");
    const groups = new Set();
    for (const trace of plot.data) {
      const group = trace.legendgroup || trace.name;
      if (!group || trace.showlegend === false || groups.has(group)) continue;
      groups.add(group);
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = trace.meta && trace.meta.label || trace.name;
      button.style.setProperty("--swatch", trace.meta && trace.meta.colour ? `var(--${trace.meta.colour})` : (trace.line || trace.marker || {}).color);
      button.setAttribute("aria-pressed", String(trace.visible !== false));
      button.addEventListener("click", () => switched(plot, group, button.getAttribute("aria-pressed") !== "true"));
      button.dataset.group = group;
      const item = document.createElement("li");
      item.append(button);
      list.append(item);
    }
    if (groups.size > 1) plot.div.before(list);
  }

  function switched(plot, group, on) {
    for (const trace of plot.data) if ((trace.legendgroup || trace.name) === group) trace.visible = on;
    for (const button of plot.div.parentElement.querySelectorAll("button[data-group]")) if (button.dataset.group === group) button.setAttribute("aria-pressed", String(on));
    for (const box of document.querySelectorAll("input[data-switch]")) if (box.dataset.switch === group) box.checked = on;
    return draw(plot);
  }

  async function start(script) {
    const { data, layout } = content(script), div = document.getElementById(script.dataset.plot);
    const plot = { div, data, layout, whole: null, window: null };
    plots.set(div.id, plot);
    const keys = data.filter((trace) => trace.meta && trace.meta.time).map((trace) => trace.meta.time);
    if (keys.length) {
      plot.whole = [Math.min(...keys.map((key) => signal(key)[0])), Math.max(...keys.map((key) => signal(key).at(-1)))];
      plot.window = plot.whole;
    }
    legend(plot);
    await draw(plot);
    if (!plot.whole) return;
    div.on("plotly_relayout", (change) => {
      const name = Object.keys(change).find((key) => /^xaxis\d*\.range/.test(key));
      if (!name) return;
      const axis = name.split(".")[0];
      const range = change[`${axis}.range`] || [change[`${axis}.range[0]`], change[`${axis}.range[1]`]];
      if (Math.abs(range[0] - plot.window[0]) + Math.abs(range[1] - plot.window[1]) > 1e-9) zoom(plot, +range[0], +range[1]);
    });
    div.on("plotly_doubleclick", () => zoom(plot, ...plot.whole));
  }

  function redraw() { for (const plot of plots.values()) if (plot.div.clientWidth) draw(plot); }

  document.addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    if (button.dataset.zoom) {
      const plot = plots.get(button.dataset.zoom);
      zoom(plot, ...(button.dataset.from ? [+button.dataset.from, +button.dataset.to] : plot.whole));
      plot.div.scrollIntoView({ block: "center" });
    } else if (button.dataset.copy) {
      const text = document.getElementById(button.dataset.copy);
      getSelection().selectAllChildren(text);
      (navigator.clipboard ? navigator.clipboard.writeText(text.textContent) : Promise.reject()).catch(() => document.execCommand("copy"));
      button.textContent = "copied";
    } else if (button.id === "theme") {
      const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
      root.dataset.theme = dark ? "light" : "dark";
      redraw();
    }
  });
  document.addEventListener("change", (event) => {
    const box = event.target;
    if (box.dataset.switch) for (const plot of plots.values()) if (plot.data.some((trace) => trace.legendgroup === box.dataset.switch)) switched(plot, box.dataset.switch, box.checked);
  });
  document.addEventListener("toggle", (event) => { if (event.target.open) redraw(); }, true);

  let chosen, folded = [];
  addEventListener("beforeprint", () => {
    chosen = root.dataset.theme;
    root.dataset.theme = "light";
    folded = [...document.querySelectorAll("details:not([open])")];
    for (const each of folded) each.open = true;
    for (const plot of plots.values()) plot.div.style.width = "680px";
    redraw();
  });
  addEventListener("afterprint", () => {
    if (chosen) root.dataset.theme = chosen; else delete root.dataset.theme;
    for (const each of folded) each.open = false;
    for (const plot of plots.values()) plot.div.style.width = "";
    redraw();
  });
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; redraw(); } });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

  Promise.all([...document.querySelectorAll("script[data-plot]")].map(start)).then(() => { root.dataset.drawn = plots.size; });
})();
