# SPDX-License-Identifier: Apache-2.0
"""Writers of moving pictures: GIF by Pillow, MP4 by ffmpeg, a page with a slider."""

import base64
from collections.abc import Iterator
from contextlib import contextmanager
import io
import json
from pathlib import Path
from subprocess import CalledProcessError

from hydra_actuator.analysis.page import asset
from hydra_actuator.errors import Failure, InputError

MOVIES = ('.gif', '.mp4', '.html')
BITS_PER_SECOND = 3000          # thousands
PALETTE = 192                   # colours of a GIF


def movie_writer(suffix: str, rate: float):
    """Return matplotlib's writer of a format; InputError where its encoder is missing."""
    from matplotlib import animation

    if suffix == '.html':
        return _page_writer(rate)
    if suffix == '.gif':
        return _gif_writer(rate)
    _find_ffmpeg()
    return animation.FFMpegWriter(fps=rate, codec='h264', bitrate=BITS_PER_SECOND)


@contextmanager
def saving(writer, figure, path: Path, dots_per_inch: int) -> Iterator[None]:
    """
    Let a writer take frames of a figure into a file.

    Ctrl-C in a terminal ends ffmpeg, too, and what it then says would hide the interruption.
    Raises Failure where the encoder fails of itself.
    """
    try:
        with writer.saving(figure, str(path), dots_per_inch):
            yield
    except (CalledProcessError, BrokenPipeError) as error:
        if _was_interrupted(error):
            raise KeyboardInterrupt from None
        raise Failure(f'the encoder failed: {error}') from error


def _was_interrupted(error: BaseException | None) -> bool:
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__context__
    return error is not None


def _find_ffmpeg() -> None:
    """Tell matplotlib where ffmpeg is: that of imageio-ffmpeg, else the machine's."""
    from matplotlib import animation, rcParams

    try:
        from imageio_ffmpeg import get_ffmpeg_exe
        rcParams['animation.ffmpeg_path'] = get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        pass
    if not animation.FFMpegWriter.isAvailable():
        raise InputError("an MP4 needs ffmpeg: pip install 'hydra_actuator[animate]', or write a "
                         '.gif or .html')


def _gif_writer(rate: float):
    """Return a writer of a GIF of one palette, undithered, so that what stands still is small."""
    from matplotlib.animation import PillowWriter
    from PIL.Image import Dither

    class GifWriter(PillowWriter):

        def finish(self):
            plain = [frame.convert('RGB') for frame in self._frames]
            palette = plain[0].quantize(PALETTE)
            first, *others = (one.quantize(palette=palette, dither=Dither.NONE) for one in plain)
            first.save(self.outfile, format='GIF', save_all=True, append_images=others, loop=0,
                       duration=round(1000 / self.fps))

    return GifWriter(fps=rate)


def _page_writer(rate: float):
    """Return a writer of one page that holds all frames and plays them."""
    from matplotlib.animation import AbstractMovieWriter

    class PageWriter(AbstractMovieWriter):

        def setup(self, fig, outfile, dpi=None):
            super().setup(fig, outfile, dpi)
            self._frames = []

        def grab_frame(self, **options):
            buffer = io.BytesIO()
            self.fig.savefig(buffer, format='png', dpi=self.dpi, **options)
            self._frames.append(base64.b64encode(buffer.getvalue()).decode('ascii'))

        def finish(self):
            pieces = asset('player.html').split('@')
            parts = {'FRAMES': json.dumps(self._frames), 'RATE': f'{rate:g}'}
            text = ''.join(parts.get(piece, piece) if k % 2 else piece
                           for k, piece in enumerate(pieces))
            with open(self.outfile, 'w', encoding='utf-8') as page:
                page.write(text)

    return PageWriter(fps=rate)
