"use strict";
(async () => {
  const byId = (id) => document.getElementById(id);
  const root = document.documentElement;
  const isDark = () => (root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  const colour = (name) => getComputedStyle(root).getPropertyValue(name).trim();
  const { scene, histories } = JSON.parse(byId("data").textContent);
  /* Each figure is in the page once; its picture is also what is saved. */
  for (const link of document.querySelectorAll("a.svg")) link.href = link.closest("figure").querySelector("img").src;
  let redraw = () => {};
  byId("theme").onclick = () => { root.dataset.theme = isDark() ? "light" : "dark"; redraw(); };
  if (!byId("plotly")) return;

  const say = (text) => { const note = byId("space-note") || byId("curves"); note.textContent = text; };
  if (typeof DecompressionStream === "undefined") {
    say("This browser is too old for the picture that turns (it has no DecompressionStream); the printed one is below.");
    return;
  }
  const inflate = async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
  };
  const code = document.createElement("script");
  code.textContent = await new Response(await inflate(byId("plotly").textContent.trim())).text();
  document.head.append(code);

  /* Whole steps, differences from frame to frame: frames x rows x axes. */
  const unpack = async (packed, frames) => {
    const steps = new Uint16Array(await inflate(packed.data));
    const size = steps.length / frames, axes = packed.low.length;
    for (let i = size; i < steps.length; i++) steps[i] = (steps[i] + steps[i - size]) & 65535;
    return (frame, row, axis = 0) => packed.low[axis] + packed.step[axis] * steps[frame * size + row * axes + axis];
  };
  const four = (value) => (Math.abs(value) < 1e-12 ? "0" : Number(value.toPrecision(4)).toString());
  /* The palette of the figures: viridis from light, slack, to dark, taut; turned round on a dark page. */
  const VIRIDIS = ["#fde725", "#addc30", "#5ec962", "#28ae80", "#21918c", "#2c728e", "#3b528b", "#472d7b", "#440154"];
  const scale = () => {
    const colours = isDark() ? VIRIDIS.slice().reverse().slice(1) : VIRIDIS.slice(1);
    return colours.map((c, i) => [i / (colours.length - 1), c]);
  };
  const SLACK = "#8c8c8c", SYMBOLS = { square: "square", circle: "circle", diamond: "diamond" };
  const inks = () => ({ "#000000": colour("--ink"), "#595959": colour("--soft") });
  const ink = (c) => inks()[c] || c;
  const settings = { responsive: true, displaylogo: false, scrollZoom: true,
    modeBarButtonsToRemove: ["toImage", "orbitRotation", "tableRotation", "lasso2d", "select2d"] };
  const looks = () => ({ paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: colour("--ink"), size: 12 } });

  let showFrame = () => {}, drawCurves = () => {};
  if (scene) await drawSpace();
  if (histories.length) { drawCurves = curves(); drawCurves(scene ? scene.time[scene.time.length - 1] : null); }

  async function drawSpace() {
    const frames = scene.time.length;
    const bars = new Uint32Array(await inflate(scene.bars));
    const fixed = new Uint8Array(await inflate(scene.fixed));
    const at = await unpack(scene.position, frames);
    const values = [];
    for (const q of scene.quantities) values.push(await unpack(q, frames));
    for (const part of scene.parts) {
      if (part.bars) part.bars = new Uint32Array(await inflate(part.bars));
      if (part.knots) part.knots = new Uint32Array(await inflate(part.knots));
    }
    const chooser = byId("quantity"), slider = byId("time"), play = byId("play");
    scene.quantities.forEach((q, i) => chooser.add(new Option(`${q.name} (${q.unit})`, i)));
    slider.max = frames - 1;
    slider.value = frames - 1;
    byId("time-control").hidden = play.hidden = frames < 2;

    const label = (bar) => `bar ${scene.knots[bars[2 * bar]]} to ${scene.knots[bars[2 * bar + 1]]}`;
    const numbers = (bar, frame) => scene.quantities.map((q, i) => `${q.name} ${four(values[i](frame, bar))} ${q.unit}`).join("<br>");
    const lines = (which, frame, q) => {
      const x = [], y = [], z = [], c = [];
      for (const bar of which) {
        for (let end = 0; end < 2; end++) {
          const knot = bars[2 * bar + end];
          x.push(at(frame, knot, 0)); y.push(at(frame, knot, 1)); z.push(at(frame, knot, 2));
          c.push(values[q](frame, bar));
        }
        x.push(null); y.push(null); z.push(null); c.push(0);
      }
      return { x, y, z, c };
    };
    /* Bars as tubes of their true thickness, which reach into one another where they turn. */
    const SIDES = 8;
    const solid = (which, frame, radius) => {
      const x = [], y = [], z = [], i = [], j = [], k = [];
      for (const bar of which) {
        const [a, b] = [0, 1].map((end) => [0, 1, 2].map((axis) => at(frame, bars[2 * bar + end], axis)));
        const along = b.map((v, n) => v - a[n]), size = Math.hypot(...along) || 1, t = along.map((v) => v / size);
        const least = t.map(Math.abs).indexOf(Math.min(...t.map(Math.abs))), e = [0, 1, 2].map((n) => (n === least ? 1 : 0));
        const cross = (p, q) => [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        const right = cross(t, e), r = Math.hypot(...right), u = right.map((v) => v / r), w = cross(t, u), start = x.length;
        for (const end of [a, b]) for (let s = 0; s < SIDES; s++) {
          const c = radius * Math.cos(2 * Math.PI * s / SIDES), d = radius * Math.sin(2 * Math.PI * s / SIDES);
          x.push(end[0] + c * u[0] + d * w[0]); y.push(end[1] + c * u[1] + d * w[1]); z.push(end[2] + c * u[2] + d * w[2]);
        }
        for (let s = 0; s < SIDES; s++) {
          const n = (s + 1) % SIDES;
          i.push(start + s, start + n); j.push(start + n, start + SIDES + n); k.push(start + SIDES + s, start + SIDES + s);
        }
      }
      return { x, y, z, i, j, k };
    };
    const coloured = scene.parts.filter((part) => part.kind === "bars" && !part.colour);
    const largest = (frame, q) => {
      let top = 0;
      for (const part of coloured) for (const bar of part.bars) top = Math.max(top, values[q](frame, bar));
      return top || 1;
    };
    /* What hangs at a knot, and the rope that a bar is of, by number. */
    const hangs = {}, roped = {};
    for (const part of scene.parts) {
      const said = `${part.name} ${part.own || ""}`.trim();
      if (part.kind === "knots" && part.own !== undefined && part.name !== "fixed knot") for (const k of part.knots) hangs[k] = `${hangs[k] || ""}<br>${said}`;
      if (part.kind === "bars" && part.colour) for (const bar of part.bars) roped[bar] = `${said}, `;
    }
    const many = bars.length / 2 > 4000;
    const traces = (frame, q) => {
      const made = [], pull = (bar) => values[0](frame, bar), about = scene.quantities[q], top = largest(frame, q);
      let scaled = false;
      const named = new Set(), first = (name) => !named.has(name) && Boolean(named.add(name));
      for (const part of scene.parts) {
        if (part.kind === "outline") {
          const [x, y, z] = [0, 1, 2].map((axis) => part.points.map((p) => p[axis]));
          made.push({ type: "scatter3d", mode: "lines", name: part.name, x, y, z, hoverinfo: "skip", showlegend: false,
            line: { color: ink(part.colour), width: 2.5 * part.width } });
        } else if (part.kind === "bars") {
          const every = Array.from(part.bars);
          const taut = part.colour ? every : every.filter((bar) => pull(bar) > 0);
          const slack = part.colour ? [] : every.filter((bar) => !(pull(bar) > 0));
          const t = lines(taut, frame, q), width = (many ? 2 : 5) * part.width;
          if (part.diameter) {
            made.push({ type: "mesh3d", name: part.name, ...solid(every, frame, part.diameter / 2), color: part.colour, hoverinfo: "skip",
              flatshading: false, lighting: { ambient: 0.7, diffuse: 0.5, specular: 0.1 }, showlegend: first(part.name) });
            made.push(middles(every, frame));
            continue;
          }
          const line = part.colour ? { color: part.colour, width } : { color: t.c, colorscale: scale(), cmin: 0, cmax: top, width,
            showscale: !scaled, colorbar: { title: { text: `${about.name} (${about.unit})`, side: narrow ? "top" : "right" }, thickness: 12, ...barPlace } };
          scaled = scaled || !part.colour;
          made.push({ type: "scatter3d", mode: "lines", name: part.name, x: t.x, y: t.y, z: t.z, hoverinfo: "skip",
            showlegend: Boolean(part.colour) && first(part.name), line });
          const s = lines(slack, frame, q);
          made.push({ type: "scatter3d", mode: "lines", name: `slack bars (${slack.length} of ${every.length})`, x: s.x, y: s.y, z: s.z,
            hoverinfo: "skip", showlegend: slack.length > 0, visible: slack.length > 0,
            line: { color: SLACK, width: many ? 1 : 3, dash: many ? "solid" : "dash" } });
          made.push(middles(every, frame));
        } else {
          const knots = Array.from(part.knots), [x, y, z] = [0, 1, 2].map((axis) => knots.map((k) => at(frame, k, axis)));
          made.push({ type: "scatter3d", mode: "markers", name: part.name, x, y, z, hoverinfo: "skip", showlegend: knots.length > 0 && first(part.name),
            marker: { symbol: SYMBOLS[part.marker], size: (many ? 2 : 3.5) * part.size, color: ink(part.colour) } });
        }
      }
      made.push(knotNames(frame));
      return made;
    };
    const unseen = (points, hover) => ({ type: "scatter3d", mode: "markers", ...points, hovertext: hover, hoverinfo: "text", showlegend: false,
      marker: { size: many ? 4 : 9, color: "rgba(0,0,0,0)", opacity: 0 } });
    const middles = (every, frame) => {
      const [x, y, z] = [0, 1, 2].map((axis) => every.map((bar) => (at(frame, bars[2 * bar], axis) + at(frame, bars[2 * bar + 1], axis)) / 2));
      return { ...unseen({ x, y, z }, every.map((bar) => `${roped[bar] || ""}${label(bar)}<br>${numbers(bar, frame)}`)), name: "bars" };
    };
    /* Beside the net, and below it on a narrow page. */
    const narrow = byId("space").clientWidth < 500;
    const barPlace = narrow ? { orientation: "h", len: 0.9, x: 0.5, xanchor: "center", y: 0, yanchor: "bottom" } : { len: 0.7, x: 1, xanchor: "right" };
    const knotNames = (frame) => {
      const every = scene.knots.map((_, k) => k), [x, y, z] = [0, 1, 2].map((axis) => every.map((k) => at(frame, k, axis)));
      const text = every.map((k) => `${fixed[k] ? "fixed " : ""}knot ${scene.knots[k]}<br>x ${x[k].toFixed(4)} m<br>y ${y[k].toFixed(4)} m<br>z ${z[k].toFixed(4)} m${hangs[k] || ""}`);
      return { ...unseen({ x, y, z }, text), name: "knots" };
    };

    const [low, high] = scene.box, longest = Math.max(...high.map((h, i) => h - low[i])) || 1;
    const half = high.map((h, i) => Math.max(h - low[i], 0.16 * longest) * 0.53), middle = high.map((h, i) => (h + low[i]) / 2);
    const [azimuth, elevation] = scene.eye.map((degrees) => degrees * Math.PI / 180);
    /* Further away on a narrow page, so that the whole net is in the picture. */
    const away = 2.4 * Math.max(1, 1.25 * byId("space").clientHeight / byId("space").clientWidth);
    const eye = { x: Math.cos(elevation) * Math.cos(azimuth) * away, y: Math.cos(elevation) * Math.sin(azimuth) * away, z: Math.sin(elevation) * away };
    /* As large as a cube of side 1 would be, but never so long nor so wide that an end or a corner is out of the picture. */
    const sides = half.map((h) => 2 * h), grow = Math.min(1 / Math.cbrt(sides[0] * sides[1] * sides[2]),
      1.85 / Math.max(...sides), 2.15 / Math.hypot(sides[0], sides[1]));
    const aspectratio = { x: sides[0] * grow, y: sides[1] * grow, z: sides[2] * grow };
    const layout = () => {
      const axis = (name, i) => ({ title: { text: `${name} (m)` }, range: [middle[i] - half[i], middle[i] + half[i]], showbackground: false,
        gridcolor: colour("--line"), linecolor: colour("--soft"), zeroline: false, nticks: narrow && name === "z" ? 3 : 5, showspikes: false });
      return { ...looks(), margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "kept", legend: { x: 0, y: 1, bgcolor: "rgba(0,0,0,0)" },
        hoverlabel: { align: "left" }, scene: { aspectmode: "manual", aspectratio, uirevision: "kept", camera: { eye, projection: { type: "perspective" } },
          xaxis: axis("x", 0), yaxis: axis("y", 1), zaxis: axis("z", 2) } };
    };
    const show = () => {
      const frame = Number(slider.value);
      byId("time-text").textContent = `${scene.time[frame].toFixed(3)} s`;
      drawCurves(scene.time[frame]);
      return Plotly.react("space", traces(frame, Number(chooser.value)), layout(), settings);
    };
    showFrame = show;
    redraw = () => { show(); drawCurves(scene.time[Number(slider.value)]); };
    chooser.onchange = show;
    slider.oninput = show;
    let running = false;
    play.onclick = async () => {
      running = !running;
      play.textContent = running ? "Pause" : "Play";
      if (running && Number(slider.value) === frames - 1) slider.value = 0;
      while (running && Number(slider.value) < frames - 1) {
        slider.value = Number(slider.value) + 1;
        await show();
        await new Promise((done) => setTimeout(done, 40));
      }
      running = false;
      play.textContent = "Play";
    };
    await show();
    window.fyke = { scene, at, values, show };
  }

  function curves() {
    const count = histories.length, gap = 0.04, height = (1 - gap * (count - 1)) / count;
    const traces = histories.map((one, i) => ({ type: "scatter", mode: "lines", x: one.time, y: one.values, name: one.name, xaxis: "x",
      yaxis: `y${count - i}`, line: { color: "#0072B2", width: 2 }, hovertemplate: `%{y:.5g} ${one.unit}` }));
    return (now) => {
      const axes = {};
      histories.forEach((one, i) => {
        const k = count - i, bottom = (k - 1) * (height + gap);
        axes[`yaxis${k}`] = { domain: [bottom, Math.min(1, bottom + height)], title: { text: `${one.name.replace(" ", "<br>")} (${one.unit})`, font: { size: 11 } },
          gridcolor: colour("--line"), zeroline: false, nticks: 5, type: one.unit === "J" ? "log" : "linear", exponentformat: "power" };
      });
      const shapes = now === null ? [] : [{ type: "line", xref: "x", yref: "paper", x0: now, x1: now, y0: 0, y1: 1, line: { color: "#D55E00", width: 1.5 } }];
      Plotly.react("curves", traces, { ...looks(), ...axes, shapes, showlegend: false, hovermode: "x unified", margin: { l: 75, r: 15, t: 10, b: 45 },
        xaxis: { title: { text: "Time (s)" }, gridcolor: colour("--line"), zeroline: false, anchor: "y" } }, { ...settings, scrollZoom: false, displayModeBar: false });
    };
  }
})();
