"""Units of what a study shows: of its knobs, of its errors, of expressions over measures."""

import ast

from abut_tools.expressions import Expression, dotted
from abut_tools.study_file import Error, Study
from abut_tools.units import COSTS, common, measure_unit

SAME = ("abs", "max", "min")


class StudyUnits:
    """In the words of the study's scenes. An empty unit is a number without one, or one that
    arithmetic has changed: 1e6 * duration may be anything."""

    def __init__(self, study: Study, systems: list[dict[str, str]]):
        self.system = common(systems)
        self.knobs = {name: self.word(unit) for name, unit in study.knob_units.items()}
        self.errors = {}
        for error in study.errors:
            self.errors[error.name] = self.of_error(error)

    def word(self, unit: str) -> str:
        """Scenes of several systems have no word in common."""
        return self.system.word(unit) if self.system else ""

    def of_error(self, error: Error) -> str:
        if error.unit is not None:
            return error.unit
        if error.history or error.relative_to is not None:
            return ""
        return self.of(error.measure)

    def of_name(self, name: str) -> str:
        for known in (self.errors, COSTS, self.knobs):
            if name in known:
                return known[name]
        return self.word(measure_unit(name))

    def of(self, expression: Expression) -> str:
        return self.of_node(expression.tree) or ""

    def of_node(self, node: ast.AST) -> str | None:
        """None: unknown."""
        name = dotted(node)
        if name is not None:
            return self.of_name(name)
        if isinstance(node, ast.Constant):
            return ""
        if isinstance(node, ast.UnaryOp):
            return self.of_node(node.operand)
        if isinstance(node, ast.BinOp):
            return self.of_operation(node)
        found = {self.of_node(argument) for argument in node.args}
        return found.pop() if len(found) == 1 and (
            dotted(node.func) in SAME or found == {""}) else None

    def of_operation(self, node: ast.BinOp) -> str | None:
        one, other = self.of_node(node.left), self.of_node(node.right)
        if one == "" and other == "":
            return ""
        if isinstance(node.op, (ast.Add, ast.Sub)):
            for side, unit in ((node.left, other), (node.right, one)):
                if isinstance(side, ast.Constant):
                    return unit
            return one if one == other else None
        if isinstance(node.op, ast.Div) and one == other and one is not None:
            return ""
        pure = other if one and not isinstance(node.right, ast.Constant) else None
        return one if isinstance(node.op, (ast.Mult, ast.Div)) and pure == "" else None


def units_of(study: Study, summaries: list[dict]) -> StudyUnits:
    return StudyUnits(study, [each.get("units", {}) for each in summaries if each])


