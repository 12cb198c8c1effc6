"""Reads the <light> elements of a world."""

from sim_bridge.sdf.element import Element
from sim_bridge.sdf.models import built_in
from sim_bridge.world import Light

# Gazebo's model://sun.
SUN = Light("sun", (0.8, 0.8, 0.8, 1.0), (0.9, 0.01, 0.001))


def read_lights(world: Element):
    """Yield the lights of a world, including those of included suns."""
    for light in world.children("light"):
        yield read_light(light)
    for include in world.children("include"):
        if built_in(include.required("uri").text) == SUN.name:
            yield SUN


def read_light(light: Element) -> Light:
    """Read a <light>."""
    diffuse = light.child("diffuse")
    words = len(diffuse.text.split()) if diffuse is not None else 0
    red, green, blue, alpha = (
        [*diffuse.numbers(words), 1.0][:4] if diffuse is not None and words in (3, 4) else (1.0,) * 4
    )
    constant, linear, quadratic = (
        light.number("attenuation", name, default=default)
        for name, default in (("constant", 1.0), ("linear", 1.0), ("quadratic", 0.0))
    )
    return Light(light.name, (red, green, blue, alpha), (constant, linear, quadratic))
