'use strict';
// Draws the figures of this page from the arrays in it; follows light and dark; links time axes.
(() => {
  const page = JSON.parse(document.getElementById('figures').textContent);
  const decoded = new Map();
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

  function resolve(value) {
    if (Array.isArray(value)) return value.map(resolve);
    if (value === null || typeof value !== 'object') return value;
    if ('$array' in value) return array(value.$array);
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
    layout.height = narrow() ? Math.min(figure.height, layout.scene ? 340 : 560) : figure.height;
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
    if (narrow() && layout.scene) layout.scene.camera.eye = { x: 1.8, y: -2.5, z: 1.2 };
    return layout;
  }

  const linked = [];
  let following = false;

  async function follow(source, change) {
    if (following) return;
    const range = change['xaxis.range'] || (change['xaxis.range[0]'] !== undefined
      ? [change['xaxis.range[0]'], change['xaxis.range[1]']] : undefined);
    if (!range && !change['xaxis.autorange']) return;
    following = true;
    const update = range ? { 'xaxis.range': range } : { 'xaxis.autorange': true };
    await Promise.all(linked.filter((plot) => plot !== source).map((plot) => Plotly.relayout(plot, update)));
    following = false;
  }

  async function draw(figure) {
    const plot = document.getElementById(figure.key);
    const layout = layoutOf(figure);
    plot.style.minHeight = `${layout.height}px`;
    try {
      await Plotly.newPlot(plot, resolve(figure.traces), layout, {
        responsive: true, displaylogo: false, scrollZoom: false,
        modeBarButtonsToRemove: ['select2d', 'lasso2d', 'autoScale2d', 'hoverClosest3d', 'resetCameraLastSave3d'],
        displayModeBar: narrow() ? false : 'hover', doubleClickDelay: 400,
      });
    } catch (error) {
      plot.textContent = `This picture could not be drawn: ${error.message}`;
      throw error;
    }
    if (figure.linked) {
      linked.push(plot);
      plot.on('plotly_relayout', (change) => follow(plot, change));
    }
  }

  async function drawAll() {
    for (const figure of page.figures) {
      await draw(figure);
      document.body.dataset.drawn = Number(document.body.dataset.drawn || 0) + 1;
      // Let the browser show what is there and take input before the next one.
      await new Promise((resume) => setTimeout(resume));
    }
  }

  dark.addEventListener('change', () => {
    for (const plot of document.querySelectorAll('.js-plotly-plot')) Plotly.relayout(plot, { template: template() });
  });
  drawAll();
})();
