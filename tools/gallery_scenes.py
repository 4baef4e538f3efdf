"""The scenes of the gallery, as Mitsuba 3 XML with $names for what the pictures change."""


def value(kind, name, content):
    return f'<{kind} name="{name}" value="{content}"/>'


def bsdf(plugin, *content):
    return f'<bsdf type="{plugin}">{"".join(content)}</bsdf>'


COPPER_ROUGH = bsdf("roughconductor", value("string", "material", "Cu"), value("float", "alpha", 0.2))
RED = value("rgb", "diffuse_reflectance", "0.6, 0.06, 0.05")
GGX = value("string", "distribution", "ggx")
CHECKS = ('<texture type="checkerboard" name="{}"><float name="color0" value="1"/><float name="color1" value="0"/>'
          '<transform name="to_uv"><scale x="8" y="4"/></transform></texture>')

# (name of the pictures, what is seen, the model). {table}, {pbsdf}, {merl} stand for files made from a recipe,
# {bumps} for a picture of heights, {normals} for one of normals.
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
    ("principled", "Disney's model, half metal under a clearcoat",
     bsdf("principled", value("rgb", "base_color", "0.6, 0.06, 0.05"), value("float", "metallic", 0.5),
          value("float", "roughness", 0.4), value("float", "clearcoat", 1), value("float", "clearcoat_gloss", 0.9))),
    ("plastic", "smooth plastic", bsdf("plastic", RED)),
    ("dipole", "translucent matter by diffusion, here from where it entered",
     bsdf("dipole", '<spectrum name="sigma_a" value="400:0.06, 500:0.04, 600:0.02, 700:0.02"/>',
          value("float", "sigma_s", 25))),
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
    ("bumpmap", "rough copper, dimpled",
     bsdf("bumpmap", '<texture type="bitmap" name="bumpmap"><string name="filename" value="{bumps}"/>'
          '<boolean name="raw" value="true"/></texture>', value("float", "scale", 1), COPPER_ROUGH)),
    ("normalmap", "rough copper, its normals turned by the same dimples",
     bsdf("normalmap", '<texture type="bitmap" name="normalmap"><string name="filename" value="{normals}"/>'
          '<boolean name="raw" value="true"/></texture>', COPPER_ROUGH)),
    ("twosided", "rough copper, both sides alike", bsdf("twosided", COPPER_ROUGH)),
    ("null", "nothing", bsdf("null")),
    ("polarizer", "a linear polarizer wrapped round", bsdf("polarizer", value("float", "theta", 45))),
    ("retarder", "an eighth of a wave wrapped round, passed twice before a linear polarizer; right: degree of circular "
     "polarization", bsdf("retarder", value("float", "delta", 45))),
    ("circular", "a circular polarizer wrapped round; right: degree of circular polarization", bsdf("circular")),
]
# Beside most models the degree of linear polarization; these make the other one.
CIRCULAR = {"retarder", "circular"}
# What stands behind a model that shows nothing by itself.
BEHIND = {"retarder": '<shape type="rectangle"><transform name="to_world"><scale value="3"/><translate z="-1.4"/></transform>'
          + bsdf("polarizer", value("float", "theta", 45)) + "</shape>"}
# Samples over those of the other models, where light comes by narrow ways.
SAMPLES = {"dielectric_dispersive": 6, "roughdielectric": 3, "thindielectric": 2, "mask": 2}

BALL = """<scene version="3.0.0">
<integrator type="path"><integer name="max_depth" value="10"/></integrator>
<sensor type="perspective"><float name="fov" value="30"/>
    <transform name="to_world"><lookat origin="0, 2.4, 5.2" target="0, 0.85, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><rfilter type="gaussian"/></film></sensor>
<shape type="sphere"><point name="center" value="0, 1, 0"/>{bsdf}</shape>
<shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/><scale value="12"/></transform>
    <bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
        <float name="color0" value="0.5"/><float name="color1" value="0.15"/>
        <transform name="to_uv"><scale x="16" y="16"/></transform></texture></bsdf></shape>
<shape type="rectangle">
    <transform name="to_world"><scale value="1.6"/><lookat origin="-3.5, 4.5, 3" target="0, 1, 0" up="0, 1, 0"/></transform>
    <emitter type="area"><rgb name="radiance" value="3.5, 3.5, 3.5"/></emitter></shape>
<emitter type="envmap"><string name="filename" value="{studio}"/><float name="scale" value="0.6"/></emitter>
</scene>
"""


def room(*contents):
    """A room with red and green walls, a lamp at its ceiling, open towards the camera."""
    def wall(transform, colour):
        return (f'<shape type="rectangle"><transform name="to_world">{transform}</transform>'
                f'<bsdf type="diffuse"><rgb name="reflectance" value="{colour}"/></bsdf></shape>')
    white = "0.7, 0.7, 0.7"
    walls = [wall('<rotate x="1" angle="-90"/>', white),
             wall('<rotate x="1" angle="90"/><translate y="2"/>', white),
             wall('<translate y="1" z="-1"/>', white),
             wall('<rotate y="1" angle="90"/><translate x="-1" y="1"/>', "0.6, 0.06, 0.05"),
             wall('<rotate y="1" angle="-90"/><translate x="1" y="1"/>', "0.1, 0.45, 0.08")]
    lamp = ('<shape type="rectangle"><transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/>'
            '<translate y="1.98"/></transform><bsdf type="diffuse"><float name="reflectance" value="0"/></bsdf>'
            '<emitter type="area"><rgb name="radiance" value="6, 6, 6"/></emitter></shape>')
    return ('<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="9"/></integrator>'
            '<sensor type="perspective"><float name="fov" value="34"/><transform name="to_world">'
            '<lookat origin="0, 1, 4.4" target="0, 1, 0" up="0, 1, 0"/></transform><film type="hdrfilm">'
            '<rfilter type="box"/></film></sensor>' + "".join(walls) + lamp + "".join(contents) + "</scene>\n")


def ball(centre, radius, model):
    return (f'<shape type="sphere"><point name="center" value="{centre}"/><float name="radius" value="{radius}"/>'
            f'{model}</shape>')


# A mirror, a glass ball and a rough metal one: every letter of the light-path expressions.
MIXED_ROOM = room(ball("-0.5, 0.4, -0.35", 0.4, bsdf("conductor", value("string", "material", "Ag"))),
                  ball("0.45, 0.32, 0.3", 0.32, bsdf("dielectric")),
                  ball("0.35, 0.25, -0.6", 0.25, COPPER_ROUGH))
# All diffuse, for radiosity.
DIFFUSE_ROOM = room(ball("-0.4, 0.4, -0.3", 0.4, bsdf("diffuse", value("float", "reflectance", 0.7))),
                    ball("0.45, 0.3, 0.25", 0.3, bsdf("diffuse", value("rgb", "reflectance", "0.1, 0.2, 0.6"))))
# A ball of haze, of air, and of pigment grains in a room with a hole for the light.
FOG_ROOM = room(
    ball("-0.45, 0.5, -0.1", 0.45, bsdf("null") + '<medium name="interior" type="homogeneous"><float name="sigma_t" '
         'value="2.5"/><float name="albedo" value="0.95"/><phase type="rayleigh"/></medium>'),
    ball("0.5, 0.4, 0.1", 0.4, bsdf("null") + '<medium name="interior" type="homogeneous"><float name="sigma_t" value="6"/>'
         '<rgb name="albedo" value="0.95, 0.8, 0.4"/><phase type="hg"><float name="g" value="0.6"/></phase></medium>'))

# A cloud of titania of 30 nm, bluish and polarizing; and a ball that scatters as marble does, by diffusion.
TRANSLUCENT_ROOM = room(
    ball("-0.45, 0.5, -0.1", 0.45, bsdf("null") + '<medium name="interior" type="homogeneous">'
         '<spectrum name="sigma_t" value="400:12, 500:4.9, 600:2.4, 700:1.3"/>'
         '<float name="albedo" value="1"/><phase type="mie"><string name="material" value="TiO2-rutile"/>'
         '<string name="binder" value="acrylic"/><float name="radius_um" value="0.03"/></phase></medium>'),
    ball("0.5, 0.4, 0.1", 0.4, bsdf("dipole", '<spectrum name="sigma_a" value="400:0.06, 500:0.04, 600:0.02, 700:0.02"/>',
                                    value("float", "sigma_s", 25)))
).replace('name="max_depth" value="9"', 'name="max_depth" value="-1"')

# Glass, plastic and metal on a dark table under a soft lamp, and a polarizer and a quarter-wave plate standing on it.
STILL_LIFE = """<scene version="3.0.0">
<integrator type="path"><integer name="max_depth" value="10"/></integrator>
<sensor type="perspective"><float name="fov" value="34"/>
    <transform name="to_world"><lookat origin="0, 2.6, 7" target="0, 0.75, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><rfilter type="gaussian"/></film></sensor>
<shape type="sphere"><point name="center" value="-1.35, 0.8, -0.3"/><float name="radius" value="0.8"/>
    <bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.05, 0.15, 0.5"/></bsdf></shape>
<shape type="sphere"><point name="center" value="0.3, 0.7, -1"/><float name="radius" value="0.7"/>
    <bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value="0.15"/></bsdf></shape>
<shape type="rectangle"><transform name="to_world"><scale x="0.45" y="0.6" z="1"/><translate x="0.1" y="0.6" z="0.9"/></transform>
    <bsdf type="polarizer"><float name="theta" value="45"/></bsdf></shape>
<shape type="rectangle"><transform name="to_world"><scale x="0.45" y="0.6" z="1"/><translate x="1.4" y="0.6" z="0.6"/></transform>
    <bsdf type="circular"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="30"/></transform>
    <bsdf type="roughplastic"><float name="diffuse_reflectance" value="0.12"/><float name="alpha" value="0.1"/></bsdf></shape>
<shape type="rectangle">
    <transform name="to_world"><scale value="1.5"/><lookat origin="-3, 5, -1" target="0, 0, 0" up="0, 0, 1"/></transform>
    <emitter type="area"><rgb name="radiance" value="8, 8, 8"/></emitter></shape>
<emitter type="envmap"><string name="filename" value="{studio}"/><float name="scale" value="0.7"/></emitter>
</scene>
"""
