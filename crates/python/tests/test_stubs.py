"""The stubs name what the module has, with the same parameters, texts and types."""

import ast
import inspect
import re
import types
import typing
from pathlib import Path

import alhazen
import alhazen.settings
import numpy
import numpy.typing
from alhazen import _alhazen

STUBS = ast.parse((Path(alhazen.__file__).parent / "_alhazen.pyi").read_text())
#: The names that annotations have.
NAMES = {**vars(typing), **vars(alhazen), "numpy": numpy, "Path": Path, "Settings": alhazen.settings.Settings}


def parameters(function: ast.FunctionDef) -> list[str]:
    arguments = function.args
    names = [argument.arg for argument in arguments.posonlyargs + arguments.args]
    names += [argument.arg for argument in arguments.kwonlyargs]
    return names + ([arguments.kwarg.arg] if arguments.kwarg else [])


def public(thing: object) -> set[str]:
    return {name for name in vars(thing) if not name.startswith("_")}


def members(node: ast.ClassDef) -> dict[str, ast.FunctionDef]:
    return {each.name: each for each in node.body if isinstance(each, ast.FunctionDef)}


def is_property(method: ast.FunctionDef) -> bool:
    return any(isinstance(each, ast.Name) and each.id == "property" for each in method.decorator_list)


def check(node: ast.FunctionDef, thing: object) -> None:
    """A function has the parameters and the text of its stub, which describes each parameter."""
    text = inspect.getdoc(thing)
    assert text and ast.get_docstring(node) == text, node.name
    if is_property(node):
        return
    assert parameters(node) == list(inspect.signature(thing).parameters), node.name
    for name in set(parameters(node)) - {"self"}:
        assert re.search(rf"\b{name}(, \w+)*:\s", text), f"{node.name} does not say what {name} is"


def test_the_module_is_described():
    described = {node.name for node in STUBS.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    assert described == public(_alhazen)
    assert described <= set(alhazen.__all__)
    for name in alhazen.__all__:
        assert getattr(alhazen, name).__doc__, name


def test_functions_and_classes_are_described():
    for node in STUBS.body:
        if isinstance(node, ast.FunctionDef):
            check(node, getattr(alhazen, node.name))
        elif isinstance(node, ast.ClassDef):
            thing = getattr(alhazen, node.name)
            assert ast.get_docstring(node) == inspect.getdoc(thing), node.name
            if issubclass(thing, Exception):
                continue
            described = {name for name in members(node) if not name.startswith("_")}
            assert described == public(thing), node.name
            for name in described:
                check(members(node)[name], getattr(thing, name))


def test_functions_of_the_package_describe_each_parameter():
    for thing in (alhazen.translate, alhazen.rotate, alhazen.scale, alhazen.look_at, alhazen.live):
        for name in inspect.signature(thing).parameters:
            assert re.search(rf"\b{name}(, \w+)*:\s", inspect.getdoc(thing)), (thing.__name__, name)


def fits(value: object, annotation: object) -> bool:
    """Whether a value is of the type that a stub says, down to the elements."""
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if annotation is typing.Any:
        return True
    if isinstance(annotation, types.UnionType):
        return any(fits(value, each) for each in arguments)
    if origin is typing.Literal:
        return value in arguments
    if annotation is None or annotation is types.NoneType:
        return value is None
    if not isinstance(value, origin or annotation):
        return False
    if origin is tuple:
        return len(value) == len(arguments) and all(map(fits, value, arguments))
    if origin is list:
        return all(fits(each, arguments[0]) for each in value)
    return True


def test_values_have_the_types_that_the_stubs_say():
    told = []
    builder = alhazen.SceneBuilder()
    builder.film(xresolution=8, yresolution=8)
    builder.light("infinite")
    scene = builder.build()
    job = alhazen.compile(scene, spp=2)
    image = job.render(progress=told.append)
    objects = {
        "Scene": scene,
        "Job": job,
        "Image": image,
        "Progress": told[0],
        "Difference": alhazen.compare(image, image),
        "Reference": builder.material("diffuse"),
        "Typed": alhazen.rgb(1, 1, 1),
        "Film": job.render_shard(1, 2),
        "SceneBuilder": builder,
    }
    classes = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}
    assert set(objects) == set(classes) - {"SceneError", "SceneWarning", "RenderWarning"}
    for name, thing in objects.items():
        for each in filter(is_property, members(classes[name]).values()):
            annotation = eval(ast.unparse(each.returns), NAMES | {"NDArray": numpy.typing.NDArray})
            value = getattr(thing, each.name)
            assert fits(value, annotation), f"{name}.{each.name} is {value!r}, not {ast.unparse(each.returns)}"


def test_a_list_is_no_tuple():
    assert fits((1, 2), tuple[int, int])
    assert not fits([1, 2], tuple[int, int]) and not fits((1.0, 2), tuple[int, int])
    assert fits([(1, 2)], list[tuple[int, int]]) and not fits([[1, 2]], list[tuple[int, int]])
