"""The stubs name what the module has, with the same parameters."""

import ast
import inspect
from pathlib import Path

import alhazen
from alhazen import _alhazen

STUBS = ast.parse((Path(alhazen.__file__).parent / "_alhazen.pyi").read_text())


def parameters(function: ast.FunctionDef) -> list[str]:
    arguments = function.args
    names = [argument.arg for argument in arguments.posonlyargs + arguments.args]
    names += [argument.arg for argument in arguments.kwonlyargs]
    return names + ([arguments.kwarg.arg] if arguments.kwarg else [])


def public(thing: object) -> set[str]:
    return {name for name in vars(thing) if not name.startswith("_")}


def test_the_module_is_described():
    described = {node.name for node in STUBS.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    assert described == public(_alhazen)
    assert described <= set(alhazen.__all__)
    for name in alhazen.__all__:
        assert getattr(alhazen, name).__doc__, name


def test_functions_and_classes_are_described():
    for node in STUBS.body:
        if isinstance(node, ast.FunctionDef):
            function = getattr(alhazen, node.name)
            assert parameters(node) == list(inspect.signature(function).parameters), node.name
            assert function.__doc__
        elif isinstance(node, ast.ClassDef) and node.name != "SceneError":
            thing = getattr(alhazen, node.name)
            methods = {each.name: each for each in node.body if isinstance(each, ast.FunctionDef)}
            assert {name for name in methods if not name.startswith("_")} == public(thing), node.name
            assert thing.__doc__
            for name, method in methods.items():
                if name.startswith("__"):
                    continue
                assert getattr(thing, name).__doc__, name
                if callable(getattr(thing, name)):
                    signature = inspect.signature(getattr(thing, name))
                    assert parameters(method) == list(signature.parameters), name
