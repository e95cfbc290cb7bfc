"""Arguments and docs of ``add`` and ``plotter.add_...``, built from the declarations.

A component's ``_make`` has the arguments that are about the data, and a docstring; settings follow them, and then what
all drawables have in common. The result is what ``help``, ``inspect``, Sphinx and ``plotter.pyi`` show.
"""

from __future__ import annotations

import inspect
import textwrap
import weakref
from typing import TYPE_CHECKING, Any

import pyvista as pv

from pvfiblets.plotting.components import register
from pvfiblets.plotting.settings.settings import Given, Setting, arguments
from pvfiblets.plotting.settings.unsupported_arguments import why_not

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from pvfiblets.plotting.settings.settings import Argument, Settings

_WIDEST = 100


def document(component: Any) -> None:
    """Give a component an ``add`` of its own whose signature and doc say all arguments."""
    made = inspect.signature(component._make)
    skipped = ("self", "settings")
    own = [one for name, one in made.parameters.items() if name not in skipped]
    last = [one for one in own if one.kind is one.VAR_KEYWORD]
    component.OWN = frozenset(one.name for one in own if one.kind is one.KEYWORD_ONLY)
    declared = {**arguments(component._SETTINGS), **component.COMMON.DECLARED}  # noqa: SLF001 - a component's
    settings = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=one.default, annotation=one.kind)
        for name, one in declared.items()
    ]
    first = inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    kept = [one for one in own if one.kind is not one.VAR_KEYWORD]
    inherited = component.add

    def add(self: Any, /, *data: Any, **arguments: Any) -> Any:
        return inherited(self, *data, **arguments)

    add.__module__, add.__qualname__ = component.__module__, f"{component.__name__}.add"
    add.__doc__ = _with_parameters(inspect.cleandoc(component._make.__doc__ or ""), declared)
    add.__signature__ = inspect.Signature(  # type: ignore[attr-defined]  # inspect looks for it
        [first, *kept, *settings, *last], return_annotation=made.return_annotation
    )
    component.add = add


def split_arguments(
    component: Any, common: type[Settings], given: dict[str, Any]
) -> tuple[dict[str, Any], Given, dict[str, Any]]:
    """Split the arguments of ``add``: what all drawables have in common, settings, and what is about the data."""
    shared = {name: given.pop(name, one.default) for name, one in common.DECLARED.items()}
    declared = component._SETTINGS  # noqa: SLF001 - as every component has it
    known, settings = arguments(declared), Given(declared, given)
    return shared, settings, {name: value for name, value in given.items() if name not in known}


def refuse_unknown(component: Any, own: Iterable[str]) -> None:
    """Raise a TypeError for unknown arguments; for those of ``add_mesh`` it names substitutes."""
    name = next((name for name in own if name not in component.OWN), None)
    if name is None:
        return
    if isinstance(getattr(component._SETTINGS, name, None), Setting):  # noqa: SLF001 - as every component has it
        raise TypeError(f"{component.ADD}() takes no {name}: set it on the actor it returns (actor.{name} = ...)")
    raise TypeError(why_not(component.ADD, name) or f"{component.ADD}() got an unexpected keyword argument {name!r}")


def plotter_method(component: Any) -> Any:
    """Register a component's ``add`` as a method of plotters, and return the class that makes it callable."""
    target = component.add

    def add(plotter: pv.BasePlotter, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
        return getattr(plotter, component.NAME).add(*arguments, **named)

    adder = _method_of_plotters(component.ADD, add, target.__doc__ or "", inspect.signature(target))
    adder.__module__ = component.__module__
    return register(component.ADD)(adder)


def replace_method(
    name: str,
    call: Callable[[Any, Callable[..., Any], tuple[Any, ...], dict[str, Any]], Any],
    module: str,
    more: str = "",
) -> None:
    """Put a function in the place of a method of plotters, as PyVista provides for."""
    # `pyvista.unregister_plotter_component(name)` undoes it.
    owner = next(kind for kind in pv.Plotter.__mro__ if name in vars(kind))
    original = vars(owner)[name]

    def replaced(plotter: pv.BasePlotter, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
        return call(plotter, original, arguments, named)

    doc = inspect.cleandoc(original.__doc__ or "") + more
    component = _method_of_plotters(name, replaced, doc, inspect.signature(original))
    component.__module__ = module
    pv.register_plotter_component(name, owner, override=True)(component)


def _method_of_plotters(
    name: str, call: Callable[[Any, tuple[Any, ...], dict[str, Any]], Any], doc: str, signature: inspect.Signature
) -> Any:
    """Return a component that is a method: ``help(plotter.NAME)`` and ``plotter.NAME?`` describe it."""
    bound = signature.replace(parameters=list(signature.parameters.values())[1:])

    class Method:
        def __new__(cls, plotter: pv.BasePlotter) -> Any:  # an object of its own would have help() tell of its class
            own = weakref.ref(plotter)

            def method(*arguments: Any, **named: Any) -> Any:
                return call(own(), arguments, named)

            method.__name__, method.__qualname__ = name, f"{type(plotter).__name__}.{name}"
            method.__doc__, method.__module__ = doc, cls.__module__
            method.__signature__ = bound  # type: ignore[attr-defined]  # inspect looks for it
            return method

    Method.__name__ = Method.__qualname__ = "".join(part.title() for part in name.split("_"))
    Method.__doc__ = doc
    return Method


def _with_parameters(doc: str, declared: dict[str, Argument]) -> str:
    """Return a docstring with declared arguments at the end of its section ``Parameters``."""
    end = doc.index("\n\nReturns\n")
    entries = [_entry(name, one) for name, one in declared.items()]
    # What takes all other arguments comes last.
    rest = doc.find("\n**", 0, end)
    place = end if rest < 0 else rest
    return doc[:place] + "\n" + "\n".join(entries) + doc[place:]


def _entry(name: str, one: Argument) -> str:
    paragraphs = [" ".join(part.split()) for part in one.argument_doc.split("\n\n")]
    wrapped = [textwrap.fill(part, _WIDEST, break_long_words=False, break_on_hyphens=False) for part in paragraphs]
    return f"{name} : {one.header}\n" + textwrap.indent("\n\n".join(wrapped), "    ")
