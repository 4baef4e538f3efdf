#!/usr/bin/env python3
"""The demo: solves, plots and renders the four materials of Collin, Pattanaik, LiKamWa & Bouatouch (2014) with no base, a
Lambertian base and a metal base, and a thickness series, and writes one page that shows them side by side."""
import argparse
import html
import pathlib
import subprocess
import sys
import time

MATERIALS = [("tio2", "Titanium dioxide"), ("fe2o3", "Iron oxide"), ("gold", "Gold"), ("alas", "Aluminium arsenide")]
BASES = [
    ("none", "No base", ['base={ type = "none" }']),
    ("lambertian", "Lambertian base", ['base={ type = "lambertian", reflectance = 0.8 }']),
    ("metal", "Metal base", ['base={ type = "metal", material = "Al" }']),
]
THICKNESSES_UM = [1, 3, 10, 30, 100]
WAVELENGTHS = "400:720:20"
EXPOSURE_EV = 0.3


class Demo:
    def __init__(self, arguments):
        self.root = pathlib.Path(__file__).resolve().parent.parent
        self.patina = pathlib.Path(arguments.patina).resolve()
        self.out = pathlib.Path(arguments.out).resolve()
        self.spp, self.width, self.height = arguments.spp, arguments.width, arguments.height
        self.out.mkdir(parents=True, exist_ok=True)
        self.steps_done, self.start = 0, time.time()
        self.steps = len(MATERIALS) * len(BASES) + len(THICKNESSES_UM)

    def run(self, *words):
        command = [str(self.patina), "-q", *map(str, words)]
        done = subprocess.run(command, cwd=self.out, stdout=subprocess.DEVNULL)
        if done.returncode != 0:
            sys.exit(f"demo: failed ({done.returncode}): {' '.join(command)}")

    def script(self, name, output):
        if not (self.out / output).exists():
            subprocess.run([sys.executable, self.root / "tools" / name, self.out / output], check=True)

    def coating(self, name, label, recipe, settings):
        """Solves one coating, plots its lobe and degree of polarization, renders it; every file starts with `name`."""
        sets = [word for setting in settings for word in ("--set", setting)]
        self.run("solve", self.root / "examples" / "paper" / f"{recipe}.toml", "-o", f"{name}.h5",
                 "--wavelengths", WAVELENGTHS, *sets)
        self.run("render", self.root / "examples" / "demo_scene.xml", "-o", f"{name}.exr", "--no-png", "--spp", self.spp,
                 "-D", f"paint={self.out / name}.h5", "-D", f"knot={self.out / 'knot.ply'}",
                 "-D", f"studio={self.out / 'studio.pfm'}", "-D", f"width={self.width}", "-D", f"height={self.height}")
        # One exposure and one white (the lights are D65) for all, so that they compare.
        self.run("image", "tonemap", f"{name}.exr", "-o", f"{name}.png", "--manual-exposure", "--exposure-ev", EXPOSURE_EV,
                 "--white-balance", "none")
        self.run("image", "dolp", f"{name}.exr", "-o", f"{name}_dolp.png", "--map", "inferno")
        self.run("image", "aolp", f"{name}.exr", "-o", f"{name}_aolp.png")
        self.steps_done += 1
        elapsed = time.time() - self.start
        left = elapsed / self.steps_done * (self.steps - self.steps_done)
        print(f"[{self.steps_done:2}/{self.steps}] {label:<42} {left:4.0f} s left", flush=True)

    def plot(self, output, kind, tables):
        self.run("plot", *[f"{name}.h5" for name, _ in tables], "--label", ",".join(label for _, label in tables),
                 "-o", output, "--kind", kind, "--theta-i-deg", 44.2, "--wavelength-nm", 560)

    def make(self):
        self.script("make_knot.py", "knot.ply")
        self.script("make_studio.py", "studio.pfm")
        for base, base_label, settings in BASES:
            for material, label in MATERIALS:
                self.coating(f"{material}_{base}", f"{label}, {base_label.lower()}", material, settings)
            tables = [(f"{material}_{base}", label) for material, label in MATERIALS]
            for kind in ("lobe", "dolp"):
                self.plot(f"{kind}_{base}.svg", kind, tables)
        for thickness in THICKNESSES_UM:
            self.coating(f"tio2_{thickness}um", f"Titanium dioxide, {thickness} um", "tio2",
                         [f"layers.0.thickness_um={thickness}"])
        tables = [(f"tio2_{thickness}um", f"{thickness} um") for thickness in THICKNESSES_UM]
        for kind in ("lobe", "dolp"):
            self.plot(f"{kind}_thickness.svg", kind, tables)
        (self.out / "index.html").write_text(self.page())
        print(f"\n{self.out / 'index.html'} ({time.time() - self.start:.0f} s)")

    def page(self):
        def picture(name, caption, note=""):
            return (f'<figure><img src="{name}" alt="{html.escape(caption)}" loading="lazy">'
                    f"<figcaption>{html.escape(caption)}{note}</figcaption></figure>")

        def row(names, suffix, note=""):
            return '<div class="row">' + "".join(picture(f"{n}{suffix}.png", label) for n, label in names) + "</div>"

        def figures(tag):
            return ('<div class="plots">' + picture(f"lobe_{tag}.svg", "BRDF lobe in the plane of incidence")
                    + picture(f"dolp_{tag}.svg", "Degree of polarization in the plane of incidence") + "</div>")

        sections = []
        for base, base_label, _ in BASES:
            names = [(f"{material}_{base}", label) for material, label in MATERIALS]
            sections.append(self.section(base_label, names, row, figures(base)))
        names = [(f"tio2_{t}um", f"{t} µm") for t in THICKNESSES_UM]
        sections.append(self.section("Titanium dioxide, thin to thick, no base", names, row, figures("thickness")))
        return PAGE.replace("{{sections}}", "\n".join(sections))

    @staticmethod
    def section(title, names, row, plots):
        return (f"<section><h2>{html.escape(title)}</h2>{row(names, '')}"
                f"<h3>Degree of linear polarization</h3>{row(names, '_dolp')}"
                f"<h3>Angle of linear polarization</h3>{row(names, '_aolp')}"
                f"<h3>The solved BRDF: unpolarized light from 44.2°, 560 nm</h3>{plots}</section>")


PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Patina: from pigment to polarized picture</title>
<style>
body { font: 16px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 1500px; padding: 1rem 2rem 4rem; color: #1c1f24; background: #fafafa; }
h1 { font-weight: 650; margin-bottom: .2rem; } h2 { margin: 2.5rem 0 .6rem; border-top: 1px solid #d6d9de; padding-top: 1.2rem; }
h3 { font-size: 1rem; font-weight: 600; color: #4a515c; margin: 1.2rem 0 .4rem; }
p { max-width: 60rem; }
.row { display: flex; gap: .7rem; } .row figure { flex: 1 1 0; min-width: 0; }
.plots { display: grid; grid-template-columns: 1fr 1fr; gap: 1rem; }
figure { margin: 0; } img { width: 100%; height: auto; display: block; border-radius: 4px; background: #fff; }
figcaption { font-size: .85rem; color: #4a515c; padding: .25rem 0; }
</style></head><body>
<h1>From pigment to polarized picture</h1>
<p>Four pigments in an acrylic binder with a smooth surface, after Collin, Pattanaik, LiKamWa &amp; Bouatouch (2014),
<i>Computation of polarized subsurface BRDF for rendering</i>. Each coating was computed from refractive indices, particle
radii, concentration and thickness: Lorenz-Mie scattering, the vector radiative transfer equation, then path tracing with
full Stokes vectors. Colours are CIE 1931. Degrees of polarization run from black (0) to pale yellow
(1); angles of polarization are hues, as bright as the light is polarized: light that vibrates along a radius of the disc has the
colour found there.</p>
{{sections}}
</body></html>
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--patina", required=True, help="the program")
    parser.add_argument("--out", required=True, help="folder to write")
    parser.add_argument("--spp", type=int, default=96)
    parser.add_argument("--width", type=int, default=400)
    parser.add_argument("--height", type=int, default=300)
    Demo(parser.parse_args()).make()


if __name__ == "__main__":
    main()
