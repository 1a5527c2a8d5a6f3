"""Arithmetic over named numbers: `abs(contact.impact.release_error) * 100`, nothing else.

All numbers are floating point ones: whole numbers of any length would let a dozen letters (9**9**9)
take all memory. What has no value whatever the measures are is refused where it is read.
"""

import ast
import math
from typing import Callable

from abut_tools.tables import ToolError

FUNCTIONS = {"abs": abs, "max": max, "min": min, "sqrt": math.sqrt, "log10": math.log10}
OPERATIONS = {ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b,
              ast.Mult: lambda a, b: a * b, ast.Div: lambda a, b: a / b,
              ast.Pow: lambda a, b: a ** b}
MOST_LETTERS = 2000


def short(text: str) -> str:
    return text if len(text) <= 80 else text[:77] + "..."


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
        if len(text) > MOST_LETTERS:
            raise ToolError(f"{where}: has {len(text)} letters. Write at most {MOST_LETTERS}.", 2)
        try:
            self.tree = ast.parse(text, mode="eval").body
            self._look(self.tree)
            self._refuse_what_has_no_value()
        except (SyntaxError, ValueError) as error:
            what = getattr(error, "msg", None) or str(error)
            raise ToolError(f"{where}: '{short(text)}' is no arithmetic expression ({what}).",
                            2) from error
        except (RecursionError, MemoryError) as error:
            raise ToolError(f"{where}: is nested too deep. Write it with fewer brackets and signs.",
                            2) from error

    def _refuse_what_has_no_value(self) -> None:
        for node in ast.walk(self.tree):
            constant = isinstance(node, (ast.BinOp, ast.Call, ast.Constant)) and not any(
                dotted(inner) in self.names for inner in ast.walk(node))
            if constant and self._real(node, lambda name: None) is None:
                raise ToolError(
                    f"{self.where}: '{short(ast.unparse(node))}' has no value: it is no number, or "
                    "one beyond 1.8e308. Write numbers that are.", 2)

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
                f"{self.where}: '{short(self.text)}' may hold numbers, names of measures, "
                f"+ - * / ** and {', '.join(FUNCTIONS)}; '{short(ast.unparse(node))}' is "
                "something else.", 2)

    def value(self, number_of: Callable[[str], float | None]) -> float | None:
        return self._real(self.tree, number_of)

    def _real(self, node: ast.AST, number_of: Callable[[str], float | None]) -> float | None:
        try:
            found = self._value(node, number_of)
        except (ArithmeticError, ValueError, TypeError):  # TypeError: roots of negative numbers
            return None
        real = isinstance(found, (int, float)) and math.isfinite(found)
        return float(found) if real else None

    def _value(self, node: ast.AST, number_of: Callable[[str], float | None]) -> float:
        name = dotted(node)
        if name is not None:
            found = number_of(name)
            if found is None:
                raise ValueError(name)
            return float(found)
        if isinstance(node, ast.Constant):
            return float(node.value)
        if isinstance(node, ast.UnaryOp):
            inner = self._value(node.operand, number_of)
            return -inner if isinstance(node.op, ast.USub) else inner
        if isinstance(node, ast.BinOp):
            return OPERATIONS[type(node.op)](self._value(node.left, number_of),
                                             self._value(node.right, number_of))
        return FUNCTIONS[dotted(node.func)](
            *(self._value(argument, number_of) for argument in node.args))
