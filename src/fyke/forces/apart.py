"""Loads and stores of which the compiler is told that they lie apart, so that loops become vector instructions.

Without that it must look before every short loop whether the arrays overlap, or give the vectors up. Four kinds of
memory never overlap within one step: what is only read (take), sums (put, summed), what is kept for the next loop of
the step (keep, kept) and what is left for the next step (leave). Arrays are C-contiguous and taken as flat; places
count in numbers and are not checked. Between two steps, settle keeps loads behind the stores before them. LLVM Language
Reference, "noalias and alias.scope metadata".
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic as _intrinsic

# What numba makes of these functions has fewer arguments than they are written with.
intrinsic: Any = _intrinsic

_SUMS, _KEPT, _NEXT = "sums", "kept", "next"


def _mark(module: Any, instruction: Any, own: str) -> Any:
    """Say of a load or store to which kind of memory it belongs, hence from which it stays clear."""
    domain = module.add_metadata(["fyke"])
    scope = {name: module.add_metadata([f"fyke {name}", domain]) for name in (_SUMS, _KEPT, _NEXT)}
    if own:
        instruction.set_metadata("alias.scope", module.add_metadata([scope.pop(own)]))
    instruction.set_metadata("noalias", module.add_metadata(list(scope.values())))
    return instruction


def _pointer(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    data = context.make_array(signature.args[0])(context, builder, args[0]).data
    return builder.gep(data, [args[1]], inbounds=True)


def _reader(own: str, meaning: str) -> Any:
    """Make a function (array, place) that reads an entry of one kind of memory."""

    def read(typing, array, place):
        def code(context, builder, signature, args):
            load = builder.load(_pointer(context, builder, signature, args))
            return _mark(builder.module, load, own)

        return (array.dtype(array, types.int64), code) if array.layout == "C" else None

    read.__doc__ = meaning
    return intrinsic(read)


def _writer(own: str, meaning: str) -> Any:
    """Make a function (array, place, number) that writes an entry of one kind of memory."""

    def write(typing, array, place, number):
        def code(context, builder, signature, args):
            store = builder.store(args[2], _pointer(context, builder, signature, args))
            _mark(builder.module, store, own)

        return (types.void(array, types.int64, array.dtype), code) if array.layout == "C" else None

    write.__doc__ = meaning
    return intrinsic(write)


take = _reader("", "Read an entry that this step does not write by put, keep or leave.")
summed = _reader(_SUMS, "Read a sum.")
put = _writer(_SUMS, "Write a sum.")
kept = _reader(_KEPT, "Read what was kept.")
keep = _writer(_KEPT, "Write what another loop of the step reads.")
leave = _writer(_NEXT, "Write what the next step reads.")


@intrinsic
def settle(typing):
    """End a step: nothing is read before what was written is there."""

    def code(context, builder, signature, args):
        builder.fence("acq_rel", targetscope="singlethread")

    return types.void(), code
