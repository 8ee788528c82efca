"""Compares an expected coverage of triangles with the coverage by Mesa's software rasterizer, llvmpipe.

    python compare.py SCENES.json

SCENES.json is `{"width": W, "height": H, "reach": R, "triangles": [...]}`. llvmpipe clips to the viewport and snaps clipped edges
again. So the viewport is larger than the picture: it extends R pixels from the picture's middle. A triangle has

    clip      its corners in homogeneous clip coordinates (x, y, z, w) of that viewport; y points down the screen, and the
              near plane is at z = -w
    screen    its snapped corners, in pixels from the top left; null if the triangle was clipped
    covered   the expected coverage: [row, first column, column after the last] for each run of covered pixels

Each triangle is drawn alone, from `clip` and, unless null, from `screen`. The standard output is
`{"renderer": R, "version": V, "triangles": [{"projected": D, "snapped": D or null}]}` with
D = `{"missing": [[column, row], ...], "extra": [...]}`. `missing` lists the pixels that only llvmpipe covers, and `extra`
lists the pixels that only `covered` contains.

If llvmpipe is missing, the script prints the reason to the standard error and exits with status 3.
"""

import json
import os
import struct
import sys

NOTHING_TO_COMPARE_WITH = 3

os.environ["LIBGL_ALWAYS_SOFTWARE"] = "1"
os.environ["GALLIUM_DRIVER"] = "llvmpipe"

VERTEX_SHADER = """
#version 330
in vec4 corner;
void main() { gl_Position = corner; }
"""

FRAGMENT_SHADER = """
#version 330
out float covered;
void main() { covered = 1.0; }
"""


def give_up(reason):
    print(reason, file=sys.stderr)
    sys.exit(NOTHING_TO_COMPARE_WITH)


def make_context():
    try:
        import moderngl
    except ImportError as error:
        give_up(f"moderngl is not installed ({error})")
    try:
        context = moderngl.create_context(standalone=True, backend="egl")
    except Exception as error:  # moderngl raises Exception itself when EGL or a driver is missing
        give_up(f"no OpenGL context without a display ({error})")
    if "llvmpipe" not in context.info["GL_RENDERER"]:
        give_up(f"OpenGL renderer: expected llvmpipe, found {context.info['GL_RENDERER']}")
    return context


class Rasterizer:
    """Draws single triangles and reads back their coverage, one byte per pixel from the top left."""

    def __init__(self, context, width, height, reach):
        self.middle, self.reach = (width // 2, height // 2), reach
        self.corners = context.buffer(reserve=3 * 16)
        program = context.program(vertex_shader=VERTEX_SHADER, fragment_shader=FRAGMENT_SHADER)
        self.triangle = context.vertex_array(program, [(self.corners, "4f", "corner")])
        self.frame = context.framebuffer([context.texture((width, height), 1, dtype="f1")])
        left, top = (middle - reach for middle in self.middle)
        self.frame.viewport = left, top, 2 * reach, 2 * reach
        self.frame.use()

    def coverage(self, corners):
        self.corners.write(b"".join(struct.pack("4f", *corner) for corner in corners))
        self.frame.clear()
        self.triangle.render()
        # Row 0 of a texture has the smallest y. In these clip coordinates, where y points down, the top of the picture has the smallest y
        # too. So the read rows start at the top of the picture, and "top" in llvmpipe's top-left rule is the top of the picture.
        return self.frame.read(components=1, alignment=1)

    def from_screen(self, points):
        """Converts positions in pixels to corners in clip coordinates."""
        middle_x, middle_y = self.middle
        return [((x - middle_x) / self.reach, (y - middle_y) / self.reach, 0, 1) for x, y in points]


def expected_coverage(spans, width, height):
    pixels = bytearray(width * height)
    for row, first, end in spans:
        pixels[row * width + first : row * width + end] = b"\xff" * (end - first)
    return bytes(pixels)


def differences(found, expected, width):
    missing, extra = [], []
    if found != expected:
        for place, (drawn, wanted) in enumerate(zip(found, expected)):
            if drawn != wanted:
                pixel = [place % width, place // width]
                (missing if drawn else extra).append(pixel)
    return {"missing": missing, "extra": extra}


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: compare.py SCENES.json")
    with open(sys.argv[1], encoding="utf-8") as file:
        scenes = json.load(file)
    width, height = scenes["width"], scenes["height"]
    context = make_context()
    rasterizer = Rasterizer(context, width, height, scenes["reach"])
    results = []
    for triangle in scenes["triangles"]:
        expected = expected_coverage(triangle["covered"], width, height)

        def compare(corners):
            return differences(rasterizer.coverage(corners), expected, width)

        screen = triangle["screen"]
        results.append(
            {
                "projected": compare(triangle["clip"]),
                "snapped": screen and compare(rasterizer.from_screen(screen)),
            }
        )
    json.dump(
        {
            "renderer": context.info["GL_RENDERER"],
            "version": context.info["GL_VERSION"],
            "triangles": results,
        },
        sys.stdout,
    )


main()
