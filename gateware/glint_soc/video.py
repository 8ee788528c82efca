"""Video modes of the scan-out."""

from dataclasses import dataclass

from .constants import SIZES


@dataclass(frozen=True)
class VideoMode:
    """A video timing: numbers of active pixels, front porch, sync and back porch pixels of a line, and the same
    numbers of lines of a frame.

    The active area is the screen, which pictures fill. `border` black lines above and below the screen are visible too; here
    they count as part of the porches. The scan-out outputs both syncs active high; `sync_low` is set if the mode has active-low
    syncs.
    """

    clk_freq: float
    pixels: tuple
    lines: tuple
    border: int = 0
    sync_low: bool = False

    @property
    def width(self):
        """Pixels of a line of the screen."""
        return self.pixels[0]

    @property
    def height(self):
        """Lines of the screen."""
        return self.lines[0]

    @property
    def frame_ticks(self):
        """Ticks of the pixel clock per frame, including blanking."""
        return sum(self.pixels) * sum(self.lines)

    @property
    def scales(self):
        """The scales at which the picture sizes fill the screen, as a mask: bit k for 2^k."""
        return sum(1 << code for code, _ in enumerate(self._shown()))

    @property
    def sizes(self):
        """The picture sizes that fill the screen, as a mask: bit k for the size of code k."""
        return sum(1 << SIZES.index(size) for size in self._shown())

    def _shown(self):
        return [size for size in SIZES if size.width <= self.width]

    def parameters(self):
        """Parameters of the module `scanout`."""
        names = ("ACTIVE", "FRONT", "SYNC", "BACK")
        return {f"p_{axis}_{name}": value for axis, values in (("H", self.pixels), ("V", self.lines))
                for name, value in zip(names, values, strict=True)} | {"p_V_BORDER": self.border}


CEA_1280X720 = VideoMode(clk_freq=74.25e6, pixels=(1280, 110, 40, 220), lines=(720, 5, 5, 20))
"""CEA-861 VIC 4: 1280x720 at 60 Hz."""

CEA_640X480 = VideoMode(clk_freq=25.2e6, pixels=(640, 16, 96, 48), lines=(360, 10 + 60, 2, 33 + 60), border=60, sync_low=True)
"""CEA-861 VIC 1: 640x480 at 60 Hz, with pictures in its 360 middle lines."""
