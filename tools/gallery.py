#!/usr/bin/env python3
"""The gallery: one small scene (a ball on a chequered floor, an area light, a studio around it) rendered with every
reflection model and every integrator, in colour and as degree of linear polarization, on one page.

Usage: gallery.py [--patina build/release/bin/patina] [--out out/gallery] [--spp 64] [--size 192] [--only NAME ...]
A picture that exists is kept (delete it to have it made anew); what the program does not know is left out, and said so.
To show more, add a line to a table below."""
import argparse
import html
import pathlib
import subprocess
import sys
import time


def value(kind, name, content):
    return f'<{kind} name="{name}" value="{content}"/>'


def bsdf(plugin, *content):
    return f'<bsdf type="{plugin}">{"".join(content)}</bsdf>'


COPPER_ROUGH = bsdf("roughconductor", value("string", "material", "Cu"), value("float", "alpha", 0.2))
RED = value("rgb", "diffuse_reflectance", "0.6, 0.06, 0.05")
GGX = value("string", "distribution", "ggx")
CHECKS = ('<texture type="checkerboard" name="{}"><float name="color0" value="1"/><float name="color1" value="0"/>'
          '<transform name="to_uv"><scale x="8" y="4"/></transform></texture>')

# (name of the pictures, what is seen, the model). {table}, {pbsdf}, {merl}, {recipe} stand for files made below.
MODELS = [
    ("diffuse", "Lambert", bsdf("diffuse", value("rgb", "reflectance", "0.6, 0.06, 0.05"))),
    ("orennayar", "Oren-Nayar, sigma 35 degrees",
     bsdf("orennayar", value("rgb", "reflectance", "0.6, 0.06, 0.05"), value("float", "sigma", 35))),
    ("phong", "modified Phong, exponent 40",
     bsdf("phong", RED, value("float", "specular_reflectance", 0.3), value("float", "exponent", 40))),
    ("lafortune", "Lafortune, a forward and a backward lobe",
     bsdf("lafortune", RED, value("vector", "lobe_1", "-1, -1, 0.8"), value("float", "exponent_1", 40),
          value("float", "weight_1", 0.25), value("vector", "lobe_2", "1, 1, 1"), value("float", "exponent_2", 8),
          value("float", "weight_2", 0.1))),
    ("plastic", "smooth plastic", bsdf("plastic", RED)),
    ("roughplastic", "rough plastic, alpha 0.2", bsdf("roughplastic", RED, value("float", "alpha", 0.2))),
    ("pplastic", "polarized plastic (Baek 2018), alpha 0.2", bsdf("pplastic", RED, value("float", "alpha", 0.2))),
    ("dielectric", "glass", bsdf("dielectric")),
    ("dielectric_dispersive", "zinc sulphide, dispersive", bsdf("dielectric", value("string", "int_ior", "ZnS"))),
    ("roughdielectric", "rough glass, GGX alpha 0.15", bsdf("roughdielectric", GGX, value("float", "alpha", 0.15))),
    ("thindielectric", "thin pane", bsdf("thindielectric")),
    ("conductor", "gold", bsdf("conductor", value("string", "material", "Au"))),
    ("roughconductor", "rough copper, alpha 0.2", COPPER_ROUGH),
    ("roughconductor_aniso", "brushed aluminium, alpha 0.05 and 0.4",
     bsdf("roughconductor", value("string", "material", "Al"), GGX, value("float", "alpha_u", 0.05),
          value("float", "alpha_v", 0.4))),
    ("paint", "paint from a recipe: titanium dioxide on aluminium", bsdf("paint", value("string", "table", "{table}"))),
    ("measured_polarized", "the same paint as a .pbsdf table",
     bsdf("measured_polarized", value("string", "filename", "{pbsdf}"))),
    ("merl", "the same paint as a MERL table", bsdf("merl", value("string", "filename", "{merl}"))),
    ("mask", "rough copper with holes", bsdf("twosided", bsdf("mask", CHECKS.format("opacity"), COPPER_ROUGH))),
    ("blendbsdf", "plastic and rough copper in squares",
     bsdf("blendbsdf", CHECKS.format("weight"), bsdf("plastic", RED), COPPER_ROUGH)),
    ("null", "nothing", bsdf("null")),
    ("polarizer", "a linear polarizer wrapped round", bsdf("polarizer", value("float", "theta", 45))),
    ("retarder", "a quarter-wave film wrapped round", bsdf("retarder", value("float", "delta", 90))),
    ("circular", "a circular polarizer wrapped round", bsdf("circular")),
]

# (plugin, what it solves); all on the scene with the rough glass ball and a plastic one.
INTEGRATORS = [
    ("appel", "E(D|G)L"), ("whitted", "ES*(D|G)L"), ("distribution", "distribution ray tracing"),
    ("path", "the rendering equation by path tracing"), ("light", "the adjoint equation: light tracing"),
    ("bidirectional", "bidirectional path tracing"), ("volumetric", "path tracing with media"),
    ("radiosity", "diffuse surfaces as a linear system"),
]

SCENE = """<scene version="3.0.0">
    <integrator type="{integrator}"><integer name="max_depth" value="10"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="32"/>
        <transform name="to_world"><lookat origin="0, 2.4, 5.2" target="0, 0.85, 0" up="0, 1, 0"/></transform>
        <sampler type="independent"><integer name="sample_count" value="{spp}"/></sampler>
        <film type="hdrfilm">
            <integer name="width" value="{size}"/><integer name="height" value="{size}"/><rfilter type="gaussian"/>
        </film>
    </sensor>
    <shape type="sphere">
        <point name="center" value="0, 1, 0"/><float name="radius" value="1"/>
        {bsdf}
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><rotate x="1" angle="-90"/><scale value="12"/></transform>
        <bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
            <float name="color0" value="0.5"/><float name="color1" value="0.15"/>
            <transform name="to_uv"><scale x="16" y="16"/></transform>
        </texture></bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale value="0.8"/><lookat origin="-3.5, 4.5, 3" target="0, 1, 0" up="0, 1, 0"/>
        </transform>
        <emitter type="area"><float name="radiance" value="14"/></emitter>
    </shape>
    <emitter type="envmap"><string name="filename" value="{studio}"/><float name="scale" value="0.6"/></emitter>
</scene>
"""

PAGE_HEAD = """<!doctype html><meta charset="utf-8"><title>Patina: gallery</title>
<style>body{font:15px/1.4 sans-serif;max-width:1400px;margin:2em auto;padding:0 1em;color:#222}
.grid{display:flex;flex-wrap:wrap;gap:1.2em}figure{margin:0;width:400px}
figure img{width:196px;margin-right:4px;background:#000}figcaption{margin:.2em 0}code{color:#555}</style>
<h1>Gallery</h1><p>Left the colour, right the degree of linear polarization (black 0, white 1).</p>
"""


class Gallery:
    def __init__(self, arguments):
        self.root = pathlib.Path(__file__).resolve().parent.parent
        self.patina = pathlib.Path(arguments.patina).resolve()
        self.out = pathlib.Path(arguments.out).resolve()
        self.spp, self.size, self.only = arguments.spp, arguments.size, arguments.only
        self.out.mkdir(parents=True, exist_ok=True)
        self.files = {name: self.out / file for name, file in
                      [("table", "paint.h5"), ("pbsdf", "paint.pbsdf"), ("merl", "paint.binary"), ("studio", "studio.pfm")]}

    def run(self, *words):
        """Runs the program; the last line of what it complains about, or None."""
        done = subprocess.run([str(self.patina), "-q", *map(str, words)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True)
        return None if done.returncode == 0 else (done.stderr.strip() or "failed")

    def make_inputs(self):
        if not self.files["studio"].exists():
            subprocess.run([sys.executable, self.root / "tools" / "make_studio.py", self.files["studio"]], check=True)
        if not self.files["table"].exists():
            problem = self.run("solve", self.root / "examples" / "tio2_on_aluminium.toml", "-o", self.files["table"],
                               "--wavelengths", "400:700:50")
            if problem:
                sys.exit(f"gallery: {problem}")
        for name in ("pbsdf", "merl"):
            if not self.files[name].exists():
                grid = ["--grid", "37x23x32"] if name == "pbsdf" else []  # a tenth of the usual size
                self.run("convert", self.files["table"], self.files[name], *grid)

    def picture(self, name, integrator, model):
        """Renders one ball; what went wrong, or None."""
        if (self.out / f"{name}_dolp.png").exists():
            return None
        scene = self.out / f"{name}.xml"
        for key, path in self.files.items():
            model = model.replace("{" + key + "}", str(path))
        scene.write_text(SCENE.format(integrator=integrator, bsdf=model, spp=self.spp, size=self.size,
                                      studio=self.files["studio"]))
        return (self.run("render", scene, "-o", self.out / f"{name}.exr")
                or self.run("image", "dolp", self.out / f"{name}.exr", "-o", self.out / f"{name}_dolp.png", "--map", "grey"))

    def section(self, title, entries):
        """Renders entries (name, caption, code, integrator, model) and returns their part of the page."""
        parts, left_out = [f"<h2>{title}</h2><div class=grid>"], []
        for name, caption, code, integrator, model in entries:
            if self.only and name not in self.only:
                continue
            start = time.time()
            problem = self.picture(name, integrator, model)
            print(f"{name:<24} {problem or f'{time.time() - start:.1f} s'}", flush=True)
            if problem:
                left_out.append((name, problem))
                continue
            parts.append(f'<figure><img src="{name}.png"><img src="{name}_dolp.png"><figcaption><b>{code}</b>: '
                         f'{html.escape(caption)}</figcaption></figure>')
        parts.append("</div>")
        unknown = [name for name, problem in left_out if "unknown" in problem]
        if unknown:
            parts.append(f"<p>Not in this program: {', '.join(unknown)}.</p>")
        for name, problem in left_out:
            if name not in unknown:
                parts.append(f"<p>{name} failed: <code>{html.escape(problem)}</code></p>")
        return "\n".join(parts)

    def make(self):
        self.make_inputs()
        glass = next(model for name, _, model in MODELS if name == "roughdielectric")
        page = PAGE_HEAD + self.section(
            "Reflection models", [(name, caption, name.split("_")[0] if name != "measured_polarized" else name, "path", model)
                                  for name, caption, model in MODELS])
        page += self.section("Integrators", [(f"integrator_{name}", caption, name, name, glass)
                                             for name, caption in INTEGRATORS])
        (self.out / "index.html").write_text(page)
        print(self.out / "index.html")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--patina", default="build/release/bin/patina")
    parser.add_argument("--out", default="out/gallery")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", type=int, default=192)
    parser.add_argument("--only", nargs="*", help="names of single pictures")
    Gallery(parser.parse_args()).make()


if __name__ == "__main__":
    main()
