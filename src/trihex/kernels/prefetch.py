"""Prefetch: ask the processor for an element that will be wanted soon."""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


@intrinsic
def prefetch(typingctx, array, index):
    """Begin to load ``array[index]`` into the cache, to be written; an index out of bounds does no harm."""

    def generate(context, builder, signature, arguments):
        data = context.make_array(array)(context, builder, arguments[0]).data
        byte = ir.IntType(8).as_pointer()
        number = ir.IntType(32)
        call = builder.module.declare_intrinsic(
            "llvm.prefetch", [byte], ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        )
        address = builder.bitcast(builder.gep(data, [arguments[1]]), byte)
        builder.call(call, [address, number(1), number(3), number(1)])  # to write, keep in all levels, data
        return context.get_dummy_value()

    return types.void(array, index), generate
