"""Arithmetic over named numbers: `abs(contact.impact.release_error) * 100`, nothing else."""

import ast
import math
from typing import Callable

from abut_tools.tables import ToolError

FUNCTIONS = {"abs": abs, "max": max, "min": min, "sqrt": math.sqrt, "log10": math.log10}
OPERATIONS = {ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b,
              ast.Mult: lambda a, b: a * b, ast.Div: lambda a, b: a / b,
              ast.Pow: lambda a, b: a ** b}


def dotted(node: ast.AST) -> str | None:
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        before = dotted(node.value)
        return None if before is None else f"{before}.{node.attr}"
    return None


class Expression:
    """Parsed once; a name without a value makes the whole expression have none."""

    def __init__(self, text: str, where: str):
        self.text, self.where, self.names = text, where, []
        try:
            self.tree = ast.parse(text, mode="eval").body
        except SyntaxError as error:
            raise ToolError(f"{where}: '{text}' is no arithmetic expression ({error.msg}).",
                            2) from error
        self._look(self.tree)

    def _look(self, node: ast.AST) -> None:
        """Nothing but numbers, names, operations and the few functions above."""
        name = dotted(node)
        if name is not None:
            self.names.append(name)
        elif isinstance(node, ast.BinOp) and type(node.op) in OPERATIONS:
            self._look(node.left)
            self._look(node.right)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            self._look(node.operand)
        elif (isinstance(node, ast.Call) and dotted(node.func) in FUNCTIONS and node.args
              and not node.keywords):
            for argument in node.args:
                self._look(argument)
        elif not (isinstance(node, ast.Constant) and isinstance(node.value, (int, float))):
            raise ToolError(
                f"{self.where}: '{self.text}' may hold numbers, names of measures, + - * / ** "
                f"and {', '.join(FUNCTIONS)}; '{ast.unparse(node)}' is something else.", 2)

    def value(self, number_of: Callable[[str], float | None]) -> float | None:
        try:
            found = self._value(self.tree, number_of)
        except (ArithmeticError, ValueError):
            return None
        real = isinstance(found, (int, float)) and math.isfinite(found)
        return float(found) if real else None

    def _value(self, node: ast.AST, number_of: Callable[[str], float | None]) -> float:
        name = dotted(node)
        if name is not None:
            found = number_of(name)
            if found is None:
                raise ValueError(name)
            return found
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.UnaryOp):
            inner = self._value(node.operand, number_of)
            return -inner if isinstance(node.op, ast.USub) else inner
        if isinstance(node, ast.BinOp):
            return OPERATIONS[type(node.op)](self._value(node.left, number_of),
                                             self._value(node.right, number_of))
        return FUNCTIONS[dotted(node.func)](
            *(self._value(argument, number_of) for argument in node.args))
