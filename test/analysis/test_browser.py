# SPDX-License-Identifier: Apache-2.0
"""
The report in a real browser: drawn, silent, in light and dark, on a desk and on a phone.

Needs Chromium (`apt install chromium`); how each page looked is left in build/screenshots.
"""

from dataclasses import replace
import io
from pathlib import Path
import shutil
import subprocess
import sys

from hydra_actuator.analysis.report import report_page
from hydra_actuator.analysis.series import Report
from hydra_actuator.cli.main import main
import numpy as np
import pytest

pytestmark = pytest.mark.once

SCREENSHOTS = Path(__file__).parents[2] / 'build' / 'screenshots'
NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
# Surfaces need WebGL, which software gives where there is no graphics card; the page itself is
# painted faster without it.
OPTIONS = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-gpu-compositing',
           '--disable-gpu-rasterization', '--disable-quic',
           '--disable-background-networking', '--disable-component-update', '--disable-sync']
PATIENCE = 480_000      # [ms] for a page to be drawn on a busy machine
DESK, PHONE = {'width': 1280, 'height': 900}, {'width': 390, 'height': 844}
PART = 4000             # [px] of a page in one screenshot
DARKEST, LIGHTEST = 60, 200     # of 255: what is a dark ground, and a light one


@pytest.fixture(scope='module')
def chromium():
    """Run a headless Chromium."""
    driver = pytest.importorskip('playwright.sync_api')
    path = next(filter(None, map(shutil.which, NAMES)), None)
    if path is None:
        pytest.skip(f'no browser here, of {", ".join(NAMES)}')
    with driver.sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=path, args=OPTIONS, chromium_sandbox=False)
        yield browser
        browser.close()


class Opened:
    """A page in the browser, fully drawn, with all that it said and asked for."""

    def __init__(self, browser, path, scheme, size):
        self._context = browser.new_context(viewport=size, color_scheme=scheme)
        self._context.set_default_timeout(PATIENCE)
        self.tab = self._context.new_page()
        self.complaints, self.requests = [], []
        self.tab.on('console', self._listen)
        self.tab.on('pageerror', lambda error: self.complaints.append(str(error)))
        self.tab.on('request', lambda request: self.requests.append(request.url))
        self.tab.goto(path.as_uri(), timeout=PATIENCE)
        self.wait('document.body.dataset.drawn == '
                  'JSON.parse(document.getElementById("figures").textContent).figures.length')

    def _listen(self, message):
        if message.type == 'error':
            self.complaints.append(message.text)

    def wait(self, condition):
        """Wait until a condition of JavaScript holds."""
        self.tab.wait_for_function(condition, timeout=PATIENCE)

    def ask(self, expression, *more):
        """Return the value of an expression of JavaScript."""
        return self.tab.evaluate(expression, *more)

    def pixels(self, selector):
        """Return an element as it looks, (height, width, 3) of 0 to 255."""
        image = pytest.importorskip('PIL.Image')
        picture = self.tab.locator(selector).first.screenshot()
        return np.asarray(image.open(io.BytesIO(picture)).convert('RGB')).astype(int)

    def keep(self, name, whole=True):
        """Leave screenshots of the page, all in parts that a graphics card can hold, or a view."""
        SCREENSHOTS.mkdir(parents=True, exist_ok=True)
        if not whole:
            self.tab.screenshot(path=SCREENSHOTS / f'{name}.png')
            return
        width, height = self.ask(
            '[document.documentElement.clientWidth, document.documentElement.scrollHeight]')
        for k, top in enumerate(range(0, height, PART)):
            self.tab.screenshot(
                path=SCREENSHOTS / f'{name}_{k + 1}.png', full_page=True,
                clip={'x': 0, 'y': top, 'width': width, 'height': min(PART, height - top)})

    def close(self):
        """Close it."""
        self._context.close()


@pytest.fixture
def open_page(chromium, tmp_path):
    """Return a function that opens a page of text."""
    opened = []

    def show(text, scheme='light', size=DESK):
        path = tmp_path / 'report.html'
        path.write_text(text, encoding='utf-8')
        opened.append(Opened(chromium, path, scheme, size))
        return opened[-1]
    yield show
    for one in opened:
        one.close()


def undrawn(page):
    """Return the keys of the figures in which a trace that is to be seen left no mark."""
    return page.ask("""() => [...document.querySelectorAll('.plot')].filter((plot) => {
      if (!plot.data) return true;
      const marks = (kind) => [...plot.querySelectorAll(kind)];
      return plot.data.some((trace, k) => {
        if (trace.visible === false) return false;
        if (trace.type === 'surface') return !plot.querySelector('.gl-container canvas');
        if (trace.type === 'heatmap') return !marks('.heatmaplayer image').length;
        return !marks('.scatterlayer .trace path').some((path) => path.getAttribute('d'));
      });
    }).map((plot) => plot.id)""")


def holes(page):
    """Return the share of each map's and surface's values that is no number, by key."""
    return page.ask("""() => Object.fromEntries([...document.querySelectorAll('.plot')]
      .flatMap((plot) => plot.data.filter((trace) => trace.z).map((trace) => {
        const values = trace.z.flatMap((row) => [...row]);
        return [plot.id, values.filter(Number.isNaN).length / values.length];
      })))""")


def colourful(pixels):
    """Return the share of pixels that are neither ground, grid nor ink."""
    return np.mean(np.ptp(pixels, axis=2) > 40)


@pytest.fixture
def eventful(run):
    """Return a run whose velocities were recorded at every tenth tick only, with a fault."""
    velocity = run.flow_velocity.copy()
    velocity[np.arange(len(velocity)) % 10 > 0] = np.nan
    faults = (Report(0.4, '/actuator: Faults', 1, 'at work', {'fault.valve_stuck': 'True'}),
              Report(0.5, '/actuator: Faults', 0, 'over', {'fault.valve_stuck': 'False'}))
    return replace(run, flow_velocity=velocity, diagnostics=run.diagnostics + faults, field=None)


def check_drawn(page, width):
    """Check that every figure is there, whole, and that the page is silent and fits."""
    assert page.complaints == []
    assert all(url.startswith(('file:', 'data:', 'blob:')) for url in page.requests)
    assert undrawn(page) == []
    found = holes(page)
    assert set(found) >= {'surface_pressure', 'surface_velocity', 'map_pressure', 'map_velocity'}
    assert max(found.values()) == 0.0
    assert page.ask('document.documentElement.scrollWidth') <= width
    for quantity in ('pressure', 'velocity'):
        assert colourful(page.pixels(f'#surface_{quantity}')) > 0.05


def check_ground(page, dark):
    """Check that the page is dark with light words, or light with dark ones."""
    ground = page.pixels('figure')[2, 2].mean()
    ink = page.pixels('#sections .xtick text').mean(axis=2)
    assert (ground < DARKEST and ink.max() > LIGHTEST) if dark else (
        ground > LIGHTEST and ink.min() < DARKEST)


def axis(page, figure, name):
    """Return the words at an axis, as they are drawn."""
    return page.tab.locator(f'#{figure} .{name}title').text_content()


def highest(page, figure, part='y'):
    """Return the highest value of the first trace of a figure."""
    return page.ask("""([id, part]) => Math.max(
      ...[...document.getElementById(id).data[0][part]]
        .flatMap((row) => (row.length ? [...row] : [row])))""", [figure, part])


def check_units(page):
    """Check that the switch changes words and numbers, and keeps the zoom into time."""
    before = {one: highest(page, one) for one in ('sections', 'streamline')}
    surface = highest(page, 'surface_pressure', 'z')
    assert axis(page, 'sections', 'y') == 'pressure [MPa abs]'

    def choose(name, number):
        page.tab.select_option('#units', label=name)
        page.wait(f'document.body.dataset.units === "{number}"')
    choose('bar', 1)
    assert axis(page, 'sections', 'y') == 'pressure [bar abs]'
    assert axis(page, 'streamline', 'y') == 'pressure [bar abs]'
    for one, value in before.items():
        assert highest(page, one) == pytest.approx(10.0 * value, rel=1e-4)
    assert highest(page, 'surface_pressure', 'z') == pytest.approx(10.0 * surface, rel=1e-4)
    assert page.ask("document.getElementById('piston').layout.xaxis.range") == [0.25, 0.5]
    assert max(page.ask("document.getElementById('piston').layout.yaxis.range")) > 45
    choose('non-dimensional', 3)
    assert axis(page, 'sections', 'y') == 'pressure p/p_max [-]'
    assert axis(page, 'sections', 'x') == 'time t c/L [-]'
    ambient, supply = 0.101325, 21.0
    assert highest(page, 'sections') == pytest.approx(
        (before['sections'] - ambient) / supply, rel=1e-4)
    page.keep('report_nondimensional', whole=False)
    choose('MPa', 0)
    assert highest(page, 'sections') == pytest.approx(before['sections'], rel=1e-6)
    assert page.complaints == []


def check_motion(page):
    """Check that slider and play button move the oil."""
    shown = '#streamline .slider-label'
    line = """document.querySelector('#streamline .scatterlayer .trace path').getAttribute('d')"""
    first, drawn = page.tab.locator(shown).first.text_content(), page.ask(line)
    page.tab.locator('#streamline .slider-rail-touch-rect').scroll_into_view_if_needed()
    rail = page.tab.locator('#streamline .slider-rail-touch-rect').bounding_box()
    # Not half way: after one and a half periods the pressures are those of the beginning.
    page.tab.mouse.click(rail['x'] + 0.4 * rail['width'], rail['y'] + 0.5 * rail['height'])
    page.wait(f'document.querySelector("{shown}").textContent !== "{first}" && '
              f'{line} !== "{drawn}"')
    chosen = page.tab.locator(shown).first.text_content()
    page.tab.locator('#streamline .updatemenu-button').first.click()
    page.wait(f'document.querySelector("{shown}").textContent !== "{chosen}"')
    page.tab.locator('#streamline .updatemenu-button').nth(1).click()


def test_a_recording_on_a_desk(open_page, run):
    # A jump of the piston long before is out of the picture that is shown first.
    page = open_page(report_page(replace(
        run, position=run.position + 0.05 * (np.arange(len(run.time)) == 100))))
    assert max(page.ask("document.getElementById('piston').layout.yaxis.range")) < 20
    page.keep('report_desk_light')
    check_drawn(page, DESK['width'])
    check_ground(page, dark=False)
    # Zoomed in one picture over time, all of them are.
    page.ask("() => Plotly.relayout('sections', {'xaxis.range': [0.25, 0.5]})")
    page.wait("document.getElementById('piston').layout.xaxis.range[0] === 0.25 && "
              "document.getElementById('command').layout.xaxis.range[1] === 0.5")
    assert max(page.ask("document.getElementById('piston').layout.yaxis.range")) > 45
    check_units(page)
    # Time in other units begins with the part shown first anew.
    assert max(page.ask("document.getElementById('piston').layout.yaxis.range")) < 20
    check_motion(page)
    page.tab.emulate_media(color_scheme='dark')
    page.wait("getComputedStyle(document.querySelector('#sections .xtick text')).fill"
              " === getComputedStyle(document.body).color")
    check_ground(page, dark=True)
    page.keep('report_desk_dark', whole=False)


def test_a_comparison_on_a_phone_in_the_dark(open_page, eventful, make_run):
    page = open_page(
        report_page(eventful, other=replace(make_run(0.9), name='another')), 'dark', PHONE)
    page.keep('comparison_phone_dark')
    check_drawn(page, PHONE['width'])
    check_ground(page, dark=True)


# Prints the time of a processor [s] and the peak of the memory [byte] that a report takes.
CHILD = """
import re, sys, time
from pathlib import Path
from hydra_actuator.analysis.report import write_report
write_report(*sys.argv[1:])
status = Path('/proc/self/status').read_text()
print(time.process_time(), 1024 * int(re.search(r'VmHWM:\\s+(\\d+) kB', status)[1]))
"""


@pytest.mark.soak
def test_a_recording_of_ten_minutes_opens_like_one_of_ten_seconds(chromium, tmp_path, capsys):
    sizes, peaks = {}, {}
    for duration in (10, 600):
        recording, path = tmp_path / f'run_{duration}', tmp_path / f'run_{duration}.html'
        assert main(['simulate', '--sine', '50', '--duration', str(duration),
                     '-o', str(recording)]) == 0
        told = subprocess.run([sys.executable, '-c', CHILD, recording, path],
                              capture_output=True, text=True, check=True).stdout
        (spent, peaks[duration]), sizes[duration] = map(float, told.split()), path.stat().st_size
        page = Opened(chromium, path, 'light', DESK)
        page.wait('performance.getEntriesByName("all pictures").length')
        first, every = (page.ask('(name) => performance.getEntriesByName(name)[0].startTime', name)
                        for name in ('first picture', 'all pictures'))
        assert page.complaints == []
        page.close()
        with capsys.disabled():
            print(f'\n{duration} s: {sizes[duration] / 1e6:.1f} MB, {spent:.1f} s of a processor '
                  f'and {peaks[duration] / 1e6:.0f} MB of memory to write; in the browser the '
                  f'first picture after {first / 1e3:.1f} s, all after {every / 1e3:.1f} s')
    # Most of either is plotly.js; lines of any length have a budget of points.
    assert sizes[600] < 1.5 * sizes[10] < 20e6
    # The states are in memory, 0.4 kB each; the field and the file are not.
    assert peaks[600] < 500e6
