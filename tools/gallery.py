#!/usr/bin/env python3
"""The gallery: every reflection model, every integrator, the light-path expressions of the lectures, the Neumann series
and the views of polarization, on one page.

Usage: gallery.py [--patina build/release/bin/patina] [--out out/gallery] [--spp 64] [--size 192]
A picture that exists is kept (delete it to have it made anew); what fails is left out, and said so. To show more, add a
line to a table here or in gallery_scenes.py."""
import argparse
import html
import json
import pathlib
import struct
import subprocess
import sys
import time

import gallery_scenes as scenes

# (plugin, what it solves, samples per pixel over those asked for) in the room of glass and metal.
INTEGRATORS = [
    ("appel", "E(D|G)L: direct light and shadows", 0.5), ("whitted", "ES*(D|G)L: and mirrors and refraction", 0.5),
    ("distribution", "E(S|G)*(D|G)?L: and glossy reflection", 0.25),
    ("path", "all paths, from the eye", 2), ("volumetric", "all paths, and media where there are any", 2),
    ("light", "from the lamp: all but ES...L", 2), ("bidirectional", "all paths, from both ends", 1),
]
# In the diffuse room, where radiosity is possible.
DIFFUSE_INTEGRATORS = [
    ("radiosity", "a linear system over patches, gathered at each pixel", 0.25, {}),
    ("radiosity", "the patches themselves", 0.1, {"gather": "false"}),
    ("path", "path tracing, to compare", 2, {}), ("bidirectional", "both ends, to compare", 1, {}),
]
# The lectures' expressions, and the methods as they name them.
EXPRESSIONS = [
    ("le", "LE", "the lamp itself"), ("lde", "LDE", "direct light on diffuse surfaces"),
    ("lse", "LSE", "the lamp in one mirror"), ("lsde", "LSDE", "light thrown by a mirror"),
    ("lssde", "LSSDE", "light focused by glass: two refractions"),
    ("indirect", "L(S|D)+DE", "all that comes by way of other surfaces, seen on a diffuse one"),
    ("appel", "E(D|G)L", "Appel (1968)"), ("whitted", "ES*(D|G)L", "Whitted (1980)"),
    ("kajiya", "E[(D|G|S)+(D|G)]L", "Kajiya (1986), as the lecture writes it"), ("all", "E.*L", "everything"),
]
NEUMANN_TERMS = 6
# (name, caption, words of `patina image` after the input)
VIEWS = [
    ("tonemap", "colour", []), ("dolp", "degree of linear polarization", ["--map", "inferno"]),
    ("aolp", "angle of linear polarization: as on the disc, bright where polarized", []),
    ("docp", "degree of circular polarization: right red, left blue", []),
    ("type", "type: linear cyan, circular yellow", []), ("chirality", "chirality: right blue, left yellow", []),
    ("stokes", "S1/S0", ["--component", 1, "--normalized", "--range", 1]),
    ("stokes", "S2/S0", ["--component", 2, "--normalized", "--range", 1]),
    ("stokes", "S3/S0", ["--component", 3, "--normalized", "--range", 1]),
    ("polarizer", "through a polarizer at 0 degrees", ["--angle-deg", 0]),
    ("polarizer", "through a polarizer at 90 degrees", ["--angle-deg", 90]),
    ("waveplate", "through a quarter-wave plate at 45 degrees", ["--angle-deg", 45]),
    ("noise", "the noise that the picture states of itself: standard error over S0", []),
]


class Gallery:
    def __init__(self, arguments):
        self.root = pathlib.Path(__file__).resolve().parent.parent
        self.patina = pathlib.Path(arguments.patina).resolve()
        self.out = pathlib.Path(arguments.out).resolve()
        self.spp, self.size = arguments.spp, arguments.size
        self.out.mkdir(parents=True, exist_ok=True)
        self.files = {name: self.out / file for name, file in
                      [("table", "paint.h5"), ("pbsdf", "paint.pbsdf"), ("merl", "paint.binary"), ("studio", "studio.pfm"),
                       ("bumps", "bumps.pfm"), ("normals", "normals.pfm")]}
        self.failures = []

    def run(self, *words):
        """Runs the program; its document, or None when it failed."""
        done = subprocess.run([str(self.patina), "-q", "--json", *map(str, words)], capture_output=True, text=True)
        if done.returncode == 0:
            return json.loads(done.stdout or "{}")
        self.failures.append((" ".join(map(str, words)), done.stderr.strip() or "failed"))
        return None

    def make_inputs(self):
        if not self.files["studio"].exists():
            subprocess.run([sys.executable, self.root / "tools" / "make_studio.py", self.files["studio"]], check=True)
        if not self.files["bumps"].exists():
            write_bumps(self.files["bumps"])
        if not self.files["normals"].exists():
            write_normals(self.files["normals"])
        if not self.files["table"].exists():
            self.run("solve", self.root / "examples" / "tio2_on_aluminium.toml", "-o", self.files["table"],
                     "--wavelengths", "400:700:50")
        for name in ("pbsdf", "merl"):
            if not self.files[name].exists():
                grid = ["--grid", "37x23x32"] if name == "pbsdf" else []  # a tenth of the usual size
                self.run("convert", self.files["table"], self.files[name], *grid)

    def render(self, name, scene, *words, spp=1.0, size=None):
        """The EXR of a scene's text; its metadata are kept beside it. None when it failed."""
        picture, note = self.out / f"{name}.exr", self.out / f"{name}.json"
        if not (picture.exists() and note.exists()):
            for key, path in self.files.items():
                scene = scene.replace("{" + key + "}", str(path))
            (self.out / f"{name}.xml").write_text(scene)
            start = time.time()
            document = self.run("render", self.out / f"{name}.xml", "-o", picture, "--no-png", "--size",
                                "{0}x{0}".format(size or self.size), "--spp", max(1, round(spp * self.spp)), *words)
            if document is None:
                return None
            note.write_text(json.dumps(document["metadata"]))
            print(f"{name:<24} {time.time() - start:.1f} s", flush=True)
        return picture

    def view(self, picture, operation, name, *words):
        target = self.out / f"{name}.png"
        if not target.exists() and self.run("image", operation, picture, "-o", target, *words) is None:
            return None
        return target

    def shown(self, picture, exposure_ev, name=None):
        """Colour at a fixed exposure, so that pictures of a row compare."""
        return self.view(picture, "tonemap", name or picture.stem, "--manual-exposure", "--exposure-ev", exposure_ev)

    @staticmethod
    def figure(images, code, caption, width):
        size = f'style="height:{width}px"' if width else "class=pair"
        tags = "".join(f'<img src="{image.name}" alt="{html.escape(f"{code} {caption}")}" {size}>' for image in images)
        label = f"<code>{html.escape(code)}</code> " if code else ""
        return (f'<figure style="width:min-content"><div style="white-space:nowrap">{tags}</div>'
                f"<figcaption>{label}{html.escape(caption)}</figcaption></figure>")

    @staticmethod
    def section(title, text, figures):
        return f"<section><h2>{title}</h2><p>{text}</p><div class=grid>{''.join(figures)}</div></section>"

    def pair(self, picture, code, caption, exposure_ev, circular=False):
        """Colour and degree of polarization side by side; nothing when the picture failed."""
        if picture is None:
            return ""
        second = (self.view(picture, "docp", f"{picture.stem}_docp") if circular else
                  self.view(picture, "dolp", f"{picture.stem}_dolp", "--map", "inferno"))
        return self.figure([image for image in (self.shown(picture, exposure_ev), second) if image], code, caption, None)

    def models(self):
        figures = []
        for name, caption, model in scenes.MODELS:
            code = "roughconductor" if name == "roughconductor_aniso" else name.replace("_dispersive", "")
            scene = scenes.BALL.replace("{bsdf}", model).replace("</scene>", scenes.BEHIND.get(name, "") + "</scene>")
            picture = self.render(name, scene, spp=1.5 * scenes.SAMPLES.get(name, 1))
            figures.append(self.pair(picture, code, caption, -0.4, name in scenes.CIRCULAR))
        return self.section("Reflection models", "A ball on a chequered floor under a small bright lamp in a studio; one "
                            "exposure for all. Left colour, right the degree of linear polarization (black 0, pale "
                            "yellow 1): black all over where a model depolarizes.", figures)

    def integrators(self):
        figures = [self.pair(self.render(f"integrator_{name}", scenes.MIXED_ROOM, "--integrator", name, spp=share), name,
                             caption, 0.6) for name, caption, share in INTEGRATORS]
        figures.append(self.pair(self.render("media", scenes.FOG_ROOM, "--integrator", "volumetric", spp=2), "volumetric",
                                 "two balls of fog: Rayleigh's phase matrix, and Henyey and Greenstein's", 0.6))
        figures.append(self.pair(self.render("translucent", scenes.TRANSLUCENT_ROOM, "--integrator", "volumetric", spp=2),
                                 "volumetric", "a cloud of titania grains (Mie); marble by the dipole's diffusion",
                                 0.6))
        diffuse = []
        for i, (name, caption, share, options) in enumerate(DIFFUSE_INTEGRATORS):
            extra = "".join(scenes.value("boolean", key, text) for key, text in options.items())
            scene = scenes.DIFFUSE_ROOM.replace('<integrator type="path">', f'<integrator type="{name}">{extra}', 1)
            if name == "radiosity":
                scene = scene.replace(scenes.value("integer", "max_depth", 9), "", 1)
            picture = self.render(f"diffuse_{i}", scene, spp=share)
            if picture:
                diffuse.append(self.figure([self.shown(picture, 0.6)], name, caption, 192))
        return (self.section("Integrators", "One room, one exposure: what each method of light transport sees of it. Mirrors "
                             "and glass before the eye stay dark to light tracing, whose paths end at a pinhole.", figures)
                + self.section("The diffuse room", "Without mirrors light transport is a linear system, and it can be "
                               "solved as one.", diffuse))

    def expressions(self):
        words = [word for name, expression, _ in EXPRESSIONS for word in ("--lpe", f"{name}={expression}")]
        whole = self.render("paths", scenes.MIXED_ROOM, "--integrator", "bidirectional", *words, spp=3)
        figures = []
        if whole:
            for name, expression, caption in EXPRESSIONS:
                image = self.shown(self.out / f"paths.{name}.exr", 0.6, f"paths_{name}")
                figures.append(self.figure([image], expression, caption, 192))
        return self.section("Light-path expressions", "The same room taken apart by what the light met on its way: L lamp, "
                            "E eye, D diffuse, G glossy, S specular. Traced from both ends in one render.", figures)

    def neumann(self):
        whole = self.render("neumann", scenes.MIXED_ROOM, "--integrator", "bidirectional", "--neumann", NEUMANN_TERMS, spp=2)
        if not whole:
            return ""
        metadata = json.loads((self.out / "neumann.json").read_text())
        figures = []
        for term in range(NEUMANN_TERMS):
            image = self.shown(self.out / f"neumann.neumann_{term:02}.exr", 0.6, f"neumann_{term}")
            ratio = metadata.get(f"neumann_ratio_{term - 1:02}")
            name = "L_e" if term == 0 else "T L_e" if term == 1 else f"T^{term} L_e"
            caption = "what shines" if term == 0 else f"scattered {term} times" if term > 1 else "scattered once"
            if ratio and term > 1:
                caption += f"; {float(ratio):.2f} of the term before"
            figures.append(self.figure([image], name, caption, 192))
        figures.append(self.figure([self.shown(self.out / "neumann.neumann_rest.exr", 0.6, "neumann_rest")], "rest",
                                   "all higher powers", 192))
        figures.append(self.figure([self.shown(whole, 0.6)], "L", "their sum, to the last bit", 192))
        norm = float(metadata["neumann_norm"])
        return self.section("Neumann series", "L = L<sub>e</sub> + T L<sub>e</sub> + T<sup>2</sup> L<sub>e</sub> + ..., one "
                            f"picture a power of the transport operator. Its measured norm, as this camera sees it: "
                            f"<b>{norm:.2f}</b>.", figures)

    def polarization(self):
        picture = self.render("still_life", scenes.STILL_LIFE, spp=3, size=256)
        reference = self.render("still_life_reference", scenes.STILL_LIFE, "--seed", 1, spp=8, size=256)
        if not picture or not reference:
            return ""
        figures = []
        for i, (operation, caption, words) in enumerate(VIEWS):
            if operation in ("tonemap", "polarizer", "waveplate"):
                source = picture
                if operation != "tonemap":
                    source = self.out / f"view_{i}.exr"
                    if not source.exists():
                        self.run("image", operation, picture, "-o", source, *words)
                image = self.shown(source, 0.3, f"view_{i}")
            else:
                image = self.view(picture, operation, f"view_{i}", *words)
            if image:
                figures.append(self.figure([image], operation, caption, 256))
        figures += self.camera(picture)
        error = self.view(picture, "error", "view_error", reference)
        return self.section("Polarization", "Plastic, gold, a linear polarizer at 45 degrees and a circular one standing on "
                            "a dark table: the views of <code>patina image</code>, and what a polarization camera makes of "
                            "them.", figures + ([] if error is None else [self.figure(
                                [error], "error", "error of S0 against a picture of 2.7 times the samples", 256)]))

    def camera(self, picture):
        """The raw frame of a polarization camera with few electrons, and the DoLP it gives back."""
        frame, back = self.out / "frame.exr", self.out / "frame_stokes.exr"
        if not back.exists():
            self.run("image", "mosaic", picture, "-o", frame, "--full-well-e", 1000, "--read-noise-e", 5, "--bits", 8)
            self.run("image", "demosaic", frame, "-o", back)
        raw = self.view(picture, "mosaic", "frame", "--full-well-e", 1000, "--read-noise-e", 5, "--bits", 8)
        dolp = self.view(back, "dolp", "frame_dolp", "--map", "inferno")
        return [self.figure([image], code, caption, 256) for image, code, caption in
                [(raw, "mosaic", "the raw frame: 1000 electrons a pixel, read noise 5, 8 bits; linear"),
                 (dolp, "demosaic", "DoLP from that frame: noise looks like polarization where it is dark")] if image]

    def missing(self):
        """Reflection models that the program has and this page does not."""
        known = self.run("plugins") or {"plugins": []}
        shown = "".join(model for _, _, model in scenes.MODELS)
        return [plugin["name"] for plugin in known["plugins"]
                if plugin["category"] == "bsdf" and f'<bsdf type="{plugin["name"]}">' not in shown]

    def make(self):
        start = time.time()
        self.make_inputs()
        page = PAGE_HEAD + self.models() + self.integrators() + self.expressions() + self.neumann() + self.polarization()
        for name in self.missing():
            page += f"<p>Not shown: <code>{html.escape(name)}</code></p>"
            print(f"not shown: {name}", file=sys.stderr)
        for command, problem in self.failures:
            page += f"<p>Failed: <code>patina {html.escape(command)}</code>: {html.escape(problem)}</p>"
            print(f"failed: patina {command}: {problem}", file=sys.stderr)
        (self.out / "index.html").write_text(page)
        print(f"{self.out / 'index.html'} ({time.time() - start:.0f} s)")
        return 1 if self.failures else 0


def write_bumps(path, width=512, height=256):
    """Heights of round dimples, in sides of the texture."""
    with open(path, "wb") as out:
        out.write(f"Pf\n{width} {height}\n-1.0\n".encode())
        for row in range(height):
            for column in range(width):
                x, y = (column * 24 / width) % 1 - 0.5, (row * 12 / height) % 1 - 0.5
                depth = max(0.0, 1 - (x * x + y * y) / 0.16)
                out.write(struct.pack("<f", -0.006 * depth * depth))


def write_normals(path, width=512, height=256):
    """Normals of the same dimples in tangent space, (n + 1)/2."""
    with open(path, "wb") as out:
        out.write(f"PF\n{width} {height}\n-1.0\n".encode())
        for row in range(height):
            for column in range(width):
                x, y = (column * 24 / width) % 1 - 0.5, (row * 12 / height) % 1 - 0.5
                depth = max(0.0, 1 - (x * x + y * y) / 0.16)
                n = (-2.5 * x * depth, -2.5 * y * depth, 1)
                length = sum(c * c for c in n) ** 0.5
                out.write(struct.pack("<3f", *(0.5 + 0.5 * c / length for c in n)))


PAGE_HEAD = """<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><title>Patina: gallery</title>
<style>body{font:15px/1.4 system-ui,sans-serif;max-width:1440px;margin:1.5em auto;padding:0 1em;color:#1c1f24;background:#fafafa}
h2{margin:2em 0 .2em;border-top:1px solid #d6d9de;padding-top:1em}p{max-width:60em;margin:.3em 0 1em}
.grid{display:flex;flex-wrap:wrap;gap:1.1em}figure{margin:0}figure img{margin-right:4px;background:#000;border-radius:3px}
.pair{height:180px}@media(max-width:900px){.pair{height:136px}}
figcaption{font-size:.85rem;color:#4a515c;padding:.15em 0}code{color:#1c1f24;font-weight:600}</style>
<h1>Gallery</h1>
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--patina", default="build/release/bin/patina")
    parser.add_argument("--out", default="out/gallery")
    parser.add_argument("--spp", type=int, default=48)
    parser.add_argument("--size", type=int, default=192)
    sys.exit(Gallery(parser.parse_args()).make())


if __name__ == "__main__":
    main()
