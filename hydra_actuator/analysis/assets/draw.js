'use strict';
// Draws the figures of this page from the arrays in it, in the chosen units; follows light and
// dark; links time axes.
(() => {
  const page = JSON.parse(document.getElementById('figures').textContent);
  const decoded = new Map();
  const choice = document.getElementById('units');
  let units = choice ? Number(choice.value) : page.units;
  const narrow = () => window.innerWidth < 620;
  const dark = window.matchMedia('(prefers-color-scheme: dark)');

  function bytes(text) {
    const raw = atob(text);
    const result = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; k++) result[k] = raw.charCodeAt(k);
    return result.buffer;
  }

  // Lines are float32; times are 32-bit and fields 16-bit steps above a lowest value, the highest
  // step standing for NaN.
  function array(index) {
    if (decoded.has(index)) return decoded.get(index);
    const packed = page.arrays[index];
    const buffer = bytes(packed.data);
    let result;
    if (packed.type === 'f4') result = new Float32Array(buffer);
    else if (packed.type === 'u4') result = numbers(new Uint32Array(buffer), packed, Float64Array);
    else result = rows(numbers(new Uint16Array(buffer), packed, Float32Array), packed.shape);
    decoded.set(index, result);
    return result;
  }

  function numbers(steps, packed, Kind) {
    const none = 2 ** (8 * steps.BYTES_PER_ELEMENT) - 1;
    return Kind.from(steps, (step) => (step === none ? NaN : packed.lowest + step * packed.step));
  }

  function rows(values, [count, width]) {
    return Array.from({ length: count }, (_, row) => values.subarray(row * width, (row + 1) * width));
  }

  function scaled(index, [factor, offset]) {
    const values = array(index);
    if (factor === 1 && offset === 0) return values;
    const one = (line) => line.map((value) => factor * value + offset);
    return Array.isArray(values) ? values.map(one) : one(values);
  }

  function resolve(value) {
    if (Array.isArray(value)) return value.map(resolve);
    if (value === null || typeof value !== 'object') return value;
    if ('$units' in value) return resolve(value.$units[units]);
    if ('$array' in value) return value.$scales ? scaled(value.$array, value.$scales[units]) : array(value.$array);
    return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, resolve(part)]));
  }

  function template() {
    const css = getComputedStyle(document.body);
    const colour = (name) => css.getPropertyValue(name).trim();
    const axis = { gridcolor: colour('--grid'), zerolinecolor: colour('--zero'), linecolor: colour('--zero'),
      tickcolor: colour('--zero'), automargin: true, exponentformat: 'power' };
    const scene = { ...axis, showbackground: false, automargin: undefined };
    return { layout: {
      paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)',
      font: { color: colour('--ink'), size: narrow() ? 11 : 12.5, family: css.fontFamily },
      xaxis: axis, yaxis: axis, scene: { xaxis: scene, yaxis: scene, zaxis: scene },
      hoverlabel: { bgcolor: colour('--ground'), font: { color: colour('--ink') } },
      legend: { bgcolor: 'rgba(0,0,0,0)' },
      modebar: { bgcolor: 'rgba(0,0,0,0)', color: colour('--quiet'), activecolor: colour('--ink') },
    } };
  }

  function layoutOf(figure) {
    const layout = resolve(figure.layout);
    layout.template = template();
    layout.autosize = true;
    // Stacked panels keep the height that the words at their axes need.
    const panels = Object.keys(layout).filter((key) => key.startsWith('yaxis')).length;
    const most = layout.scene ? 340 : Math.max(560, 150 * panels);
    layout.height = narrow() ? Math.min(figure.height, most) : figure.height;
    layout.margin = layout.scene ? { l: 0, r: 0, t: 0, b: 0 } : { l: narrow() ? 44 : 58, r: 8, t: 12, b: 40 };
    if (layout.updatemenus) {
      layout.margin.t = 44;
      for (const menu of layout.updatemenus) {
        // The chosen button is always nearly white, so all of them are light on any ground.
        menu.bgcolor = '#c9ced4';
        menu.bordercolor = '#9aa3ac';
        menu.font = { color: '#1c2126', size: 11 };
        menu.pad = { l: 0, r: 0, t: 0, b: 2 };
      }
    }
    // A finger on a picture scrolls the page.
    if (narrow() && !layout.scene) layout.dragmode = false;
    if (narrow() && layout.sliders) layout.sliders[0].pad.t = 60;
    if (narrow() && layout.scene) {
      layout.scene.camera.eye = { x: 1.95, y: -2.7, z: 1.3 };
      layout.scene.yaxis.title.font = { size: 9 };
    }
    return layout;
  }

  const linked = [];
  // Axes whose range is that of the part of the run shown first; it does not hold for another.
  const fitted = new Map();

  function fit(plot, figure) {
    fitted.set(plot, Object.keys(figure.layout).filter((key) => key.startsWith('yaxis') && figure.layout[key].range));
  }

  function unfit(plot) {
    const axes = fitted.get(plot) || [];
    fitted.set(plot, []);
    return Object.fromEntries(axes.map((key) => [`${key}.autorange`, true]));
  }

  let following = false;

  async function follow(source, change) {
    if (following) return;
    const range = change['xaxis.range'] || (change['xaxis.range[0]'] !== undefined
      ? [change['xaxis.range[0]'], change['xaxis.range[1]']] : undefined);
    if (!range && !change['xaxis.autorange']) return;
    following = true;
    const update = range ? { 'xaxis.range': range } : { 'xaxis.autorange': true };
    await Promise.all(linked.filter((plot) => plot !== source).map((plot) => Plotly.relayout(plot, { ...update, ...unfit(plot) })));
    following = false;
  }

  const config = () => ({
    responsive: true, displaylogo: false, scrollZoom: false,
    modeBarButtonsToRemove: ['select2d', 'lasso2d', 'autoScale2d', 'hoverClosest3d', 'resetCameraLastSave3d'],
    displayModeBar: narrow() ? false : 'hover', doubleClickDelay: 400,
  });

  async function draw(figure) {
    const plot = document.getElementById(figure.key);
    const layout = layoutOf(figure);
    plot.style.minHeight = `${layout.height}px`;
    try {
      await Plotly.newPlot(plot, { data: resolve(figure.traces), layout, frames: resolve(figure.frames), config: config() });
    } catch (error) {
      plot.textContent = `This picture could not be drawn: ${error.message}`;
      throw error;
    }
    if (figure.linked) {
      linked.push(plot);
      fit(plot, figure);
      plot.on('plotly_relayout', (change) => follow(plot, change));
    }
  }

  // In other units: what was turned, zoomed into (where the axis is the same) or hidden stays so.
  async function redraw(figure) {
    const plot = document.getElementById(figure.key);
    const layout = layoutOf(figure);
    const before = plot.layout;
    if (layout.scene) layout.scene.camera = before.scene.camera;
    if (figure.linked && before.xaxis.title.text === layout.xaxis.title.text) {
      layout.xaxis.range = before.xaxis.range;
      for (const key of Object.keys(layout).filter((one) => one.startsWith('yaxis'))) {
        if (!fitted.get(plot).includes(key)) delete layout[key].range;
      }
    } else if (figure.linked) fit(plot, figure);
    const traces = resolve(figure.traces);
    traces.forEach((trace, k) => { if (plot.data[k].visible !== undefined) trace.visible = plot.data[k].visible; });
    if (layout.updatemenus && !figure.frames.length) layout.updatemenus[0].active = before.updatemenus[0].active;
    await (figure.frames.length
      ? Plotly.newPlot(plot, { data: traces, layout, frames: resolve(figure.frames), config: config() })
      : Plotly.react(plot, traces, layout, config()));
  }

  let drawing = Promise.resolve();

  async function redrawAll(chosen) {
    for (const figure of page.figures) {
      if (units !== chosen) return;
      if (JSON.stringify(figure).match(/"\$(units|scales)"/)) await redraw(figure);
      await new Promise((resume) => setTimeout(resume));
    }
    document.body.dataset.units = chosen;
  }

  if (choice) choice.addEventListener('change', () => {
    units = Number(choice.value);
    drawing = drawing.then(() => redrawAll(units));
  });

  async function drawAll() {
    for (const figure of page.figures) {
      await draw(figure);
      if (!document.body.dataset.drawn) performance.mark('first picture');
      document.body.dataset.drawn = Number(document.body.dataset.drawn || 0) + 1;
      // Let the browser show what is there and take input before the next one.
      await new Promise((resume) => setTimeout(resume));
    }
    performance.mark('all pictures');
  }

  dark.addEventListener('change', () => {
    for (const plot of document.querySelectorAll('.js-plotly-plot')) Plotly.relayout(plot, { template: template() });
  });
  drawing = drawAll();
})();
