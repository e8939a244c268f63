const shown = (value, unit) =>
    Number.isFinite(value) ? `${Number(value.toPrecision(3))}${unit ? " " + unit : ""}` : "not known";

const element = (tag, parent, properties = {}) => {
  const made = Object.assign(document.createElement(tag), properties);
  if (parent) parent.append(made);
  return made;
};

/// Mouse, touch and keys: turn, move, zoom, choose.
function listen(specimen) {
  const canvas = specimen.canvas, held = new Map();
  let moved = 0;
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    moved = 0;
  });
  canvas.addEventListener("pointermove", event => {
    const last = held.get(event.pointerId);
    if (!last) return;
    const step = [event.clientX - last[0], event.clientY - last[1]], box = canvas.getBoundingClientRect();
    moved += Math.hypot(...step);
    if (held.size == 2) {
      const other = [...held.entries()].find(([id]) => id != event.pointerId)[1];
      const apart = p => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      specimen.zoom_by(apart([event.clientX, event.clientY]) / apart(last));
    } else if (event.shiftKey || event.buttons & 6) {
      const scale = specimen.scale();
      specimen.shift = [
        specimen.shift[0] + 2 * step[0] / box.width / scale[0], specimen.shift[1] - 2 * step[1] / box.height / scale[1]
      ];
    } else {
      specimen.turn(-0.008 * step[0], 0.008 * step[1]);
    }
    held.set(event.pointerId, [event.clientX, event.clientY]);
    specimen.ask();
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, event => {
      if (held.delete(event.pointerId) && end == "pointerup" && moved < 4)
        specimen.choose(specimen.bead_at(event.clientX, event.clientY));
    });
  canvas.addEventListener("webglcontextlost", event => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => {
    specimen.prepare();
    specimen.refill();
  });
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    specimen.zoom_by(Math.exp(-0.0015 * event.deltaY));
  }, {passive: false});
  canvas.addEventListener("keydown", event => {
    const step = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]}[event.key];
    if (step) specimen.turn(...step);
    else if (event.key == "+" || event.key == "-") specimen.zoom_by(event.key == "+" ? 1.1 : 1 / 1.1);
    else return;
    event.preventDefault();
  });
  new ResizeObserver(() => specimen.ask()).observe(canvas);
}

function add_controls(specimen, figure) {
  const {data} = specimen, panel = element("div", figure.querySelector(".controls"));
  const labelled = (text, tag, properties, parent = panel) => {
    const label = element("label", parent, {textContent: text + " "});
    return element(tag, label, properties);
  };
  const choice = (text, entries, start, chosen) => {
    const select = labelled(text, "select");
    for (const [value, name] of entries) element("option", select, {value, textContent: name});
    select.value = start;
    select.addEventListener("change", () => chosen(select.value));
    return select;
  };
  if (data.moments.length > 1) {
    const slider = labelled("Strain", "input", {type: "range", min: 0, max: data.moments.length - 1, step: 1});
    slider.value = specimen.moment;
    slider.className = "moment";
    slider.addEventListener("input", () => {
      specimen.moment = Number(slider.value);
      specimen.refill();
    });
  }
  specimen.label = element("output", panel, {className: "label"});
  choice("Colour", data.fields.map((field, k) => [k, field.name]), 0, value => {
    specimen.field = Number(value);
    specimen.refill();
  }).className = "field";
  const legend = element("span", panel, {className: "legend"});
  specimen.ends = [0, 1].map(end => {
    const input = element("input", legend, {type: "number", step: "any", ariaLabel: end ? "highest" : "lowest"});
    input.addEventListener("change", () => {
      const value = Number(input.value), range = [...specimen.ranges[specimen.field]];
      range[end] = value;
      if (input.value !== "" && range[0] < range[1]) specimen.ranges[specimen.field] = range;
      specimen.refill();
    });
    return input;
  });
  specimen.bar = element("canvas", null, {width: 65, height: 1, className: "bar"});
  specimen.ends[0].after(specimen.bar);
  specimen.unit = element("span", legend);
  choice("Section", [["none", "none"], ["x", "across x"], ["y", "across y"], ["z", "across z"],
                     ["eye", "facing you"]], "none", value => {
    specimen.section = value;
    specimen.ask();
  }).className = "section";
  const cut = labelled("at", "input", {type: "range", min: 0, max: 1, step: 0.005, value: 0.5, className: "cut"});
  cut.addEventListener("input", () => {
    specimen.cut_at = Number(cut.value);
    specimen.ask();
  });
  const swell = labelled("Beads", "input", {type: "range", min: 0, max: 1, step: 0.05, value: 1});
  swell.className = "swell";
  swell.addEventListener("input", () => {
    specimen.swell = Number(swell.value);
    specimen.ask();
  });
  if (specimen.pairs.length > 0) {
    ["bonds", "broken bonds", "contacts"].forEach((text, state) => {
      const box = labelled(text, "input", {type: "checkbox", checked: specimen.states[state]});
      box.addEventListener("change", () => {
        specimen.states[state] = box.checked;
        specimen.refill();
      });
    });
    if (data.pair_fields.length > 0)
      choice("coloured by", [[-1, "state"], ...data.pair_fields.map((field, k) => [k, field.name])], -1, value => {
        specimen.pair_field = Number(value);
        specimen.refill();
      });
  }
  const find = labelled("Bead", "input", {type: "number", className: "find"});
  find.addEventListener("change", () => specimen.choose(data.ids.indexOf(Number(find.value))));
  for (const [text, azimuth, elevation] of [["Front", 0, 0], ["Side", Math.PI / 2, 0], ["Top", 0, Math.PI / 2]])
    element("button", panel, {type: "button", textContent: text}).addEventListener("click", () => {
      specimen.reset();
      Object.assign(specimen, {azimuth, elevation});
      specimen.ask();
    });
  specimen.numbers = element("dl", figure.querySelector(".controls"), {className: "numbers"});
}

/// Brings label, legend and the chosen bead's numbers up to date.
function say(specimen) {
  const field = specimen.data.fields[specimen.field], range = specimen.ranges[specimen.field];
  specimen.label.textContent = specimen.data.moments[specimen.moment].label;
  specimen.ends.forEach((input, end) => input.value = Number(range[end].toPrecision(3)));
  specimen.unit.textContent = field.unit;
  const map = specimen.maps[field.map], picture = new ImageData(65, 1);
  for (let k = 0; k < 65; ++k)
    picture.data.set([map[3 * k], map[3 * k + 1], map[3 * k + 2], 255], 4 * k);
  specimen.bar.getContext("2d").putImageData(picture, 0, 0);
  specimen.numbers.replaceChildren();
  if (specimen.chosen < 0) return;
  const now = unpacked(specimen.data.moments[specimen.moment]), bead = specimen.chosen;
  const row = (name, value) => {
    element("dt", specimen.numbers, {textContent: name});
    element("dd", specimen.numbers, {textContent: value});
  };
  row("bead", String(specimen.data.ids[bead]));
  row("diameter", shown(1000 * specimen.diameters[bead], "\u00b5m"));
  row("centre x, y, z", specimen.centre(bead).map(v => v.toFixed(4)).join(", ") + " mm");
  specimen.data.fields.forEach(
      (one, k) => row(one.name, shown(fromHalf(now.values[k][bead]) * one.unit_of_value, one.unit)));
}

addEventListener("DOMContentLoaded", () => {
  for (const figure of document.querySelectorAll("figure.specimen")) {
    const note = figure.querySelector(".note");
    try {
      const specimen = new Specimen(figure, JSON.parse(figure.querySelector("script").textContent));
      figure.classList.add("alive");
      note.remove();
      specimen.draw();
    } catch (error) {
      note.textContent = `The specimen cannot be turned here (${error.message}); the pictures remain.`;
    }
  }
});
