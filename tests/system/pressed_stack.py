"""A stack of four unlike bodies that statics press together, yielding and odd enough that sweeps
take long in its windows. Where they may not, it goes passively."""

PRESSURE, WIDTH = 1.0e5, 0.67  # [Pa] at the end of statics, on the uppermost body; [m], 1 m thick

PASSIVELY = ("--set", "schwarz.max_iterations=1")  # options of a run

LAWS = {
    "soft": "j2_plasticity: {youngs_modulus: 3.32e7, poissons_ratio: 0.2, density: 8000.0, "
            "yield_stress: 6.63e4, hardening: 3.32e6}",
    "hard": "j2_plasticity: {youngs_modulus: 1.11e8, poissons_ratio: 0.2, density: 1000.0, "
            "yield_stress: 2.21e5, hardening: 1.11e7}",
    "finite": "neo_hookean: {youngs_modulus: 1.11e8, poissons_ratio: 0.0, density: 8000.0}",
    "linear": "linear_elastic: {youngs_modulus: 1.11e8, poissons_ratio: 0.0, density: 1000.0}"}

MOTION = """stages:
  go:
    time: {end: 1.0001, window: 1.0e-5}
    bodies:
      b0: {integrator: {central_difference: {step: 1.0e-5}}}
      b1: {integrator: {newmark: {step: 1.0e-5}}}
      b2: {integrator: {central_difference: {step: 1.0e-5}}}
      b3: {integrator: {newmark: {step: 1.0e-5}}}
"""


def pressed_stack(start: str = "", then: str = "") -> str:
    """b1 is drawn 2 mm into b0, and b2 0.2 mm into b1; `start`: keys of b1's `initial`."""
    def body(name, at, lengths, cells, element, law, more=""):
        return f"""
  {name}:
    model: {{fe: {{dimension: 2, mesh: {{rectangle: {{lengths: {lengths}, elements: {cells},
                                                element: {element}}}}}}}}}
    material: {{{LAWS[law]}}}
    integrator: {{quasi_static: {{step: 0.125}}}}
    initial: {{position: {at}{start if name == "b1" else ""}}}
    ports: {{up: {{side: top}}, down: {{side: bottom}}}}{more}"""

    floor = """
    constraints: {floor: {on: bottom, fixed: true}}"""
    press = f"""
    constraints: {{side: {{on: left, x: "0"}}}}
    loads: {{press: {{on: top, pressure: "{PRESSURE} * min(t, 1)"}}}}"""
    return ("time: {end: 1.0, window: 0.125}\nbodies:"
            + body("b0", [0.037, 0.0], [0.82, 0.42], [5, 2], "tri3", "soft", floor)
            + body("b1", [-0.098, 0.418], [0.8, 0.367], [4, 2], "quad8", "hard")
            + body("b2", [-0.014, 0.7848], [0.53, 0.45], [3, 2], "tri6", "finite")
            + body("b3", [-0.06, 1.2348], [WIDTH, 0.38], [3, 2], "quad4", "linear", press)
            + """
interfaces:
  i1: {sides: [b0.up, b1.down], contact: {}}
  i2: {sides: [b1.up, b2.down], contact: {}}
  i3: {sides: [b2.up, b3.down], contact: {}}
output: {checkpoint: {windows: 1}}
""" + then)
