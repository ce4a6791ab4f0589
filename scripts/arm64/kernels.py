"""What the hottest kernels consist of: the share of vector instructions (NEON) among those that are executed."""

import bisect
import re
import subprocess

from .commands import Unusable

# The files of src/core/kernels that take the most time of a pair in flight.
HOTTEST = ("window/parabolic_window", "image/smoothing", "block/pair_sums", "block/block_sums", "window/strip",
           "samples/seen_rays", "window/window_planes", "image/harris_rows", "lanes/order_statistic", "edges/edge_growth")
LEAST_SHARE = 0.05  # of what a kernel executes
# A full vector register as an operand. What only loads, stores or copies vectors does not count.
VECTOR = re.compile(r"\bv\d+\.(16b|8h|4s|2d)\b")
NO_ARITHMETIC = re.compile(r"(mov|movi|mvni|fmov|dup|ins|umov|smov|ld\d|st\d)\b")
INSTRUCTION_BYTES = 4


class Function:
    """executed: instructions, of them vector: that compute with vectors."""

    def __init__(self, name):
        self.name, self.executed, self.vector = name, 0, 0

    def add(self, other):
        self.executed += other.executed
        self.vector += other.vector

    @property
    def share(self):
        return self.vector / self.executed if self.executed else 0


def tool(name, *arguments):
    result = subprocess.run([name, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            universal_newlines=True)
    if result.returncode != 0:
        raise Unusable(f"{name} failed: {result.stderr.strip()}")
    return result.stdout


def functions_of(file, kinds):
    """(address, name) of each function in a library or an object file. kinds: letters of nm."""
    lines = (line.split(" ", 2) for line in tool("aarch64-linux-gnu-nm", "--defined-only", file).splitlines())
    return sorted((int(address, 16), name) for address, kind, name in lines if kind in kinds and not name.startswith("$"))


def vector_instructions(listing):
    """Addresses of the instructions that compute with vectors, in what objdump writes."""
    addresses = set()
    for line in listing.splitlines():
        fields = line.split("\t")
        if len(fields) >= 4 and VECTOR.search(fields[3]) and not NO_ARITHMETIC.match(fields[2]):
            addresses.add(int(fields[0].strip().rstrip(":"), 16))
    return addresses


def read_blocks(path):
    """(offset, instructions, executions) of each block that count_blocks.c noted."""
    with open(str(path), encoding="utf-8") as file:
        return [tuple(map(int, line.split())) for line in file]


def count(library, blocks):
    """The functions of the library that were executed, by name."""
    known = functions_of(library, "tTwW")
    starts = [address for address, _ in known]
    vectors = vector_instructions(tool("aarch64-linux-gnu-objdump", "--disassemble", library))
    functions = {}
    for offset, instructions, executions in blocks:
        place = bisect.bisect_right(starts, offset) - 1
        if place < 0:
            continue
        function = functions.setdefault(known[place][1], Function(known[place][1]))
        function.executed += instructions * executions
        block = range(offset, offset + INSTRUCTION_BYTES * instructions, INSTRUCTION_BYTES)
        function.vector += executions * sum(address in vectors for address in block)
    return functions


def kernel(name, objects, functions):
    """All that was executed of a file of src/core/kernels. objects: folder with its object file."""
    file = objects / f"{name}.cpp.o"
    if not file.exists():
        raise Unusable(f"scripts/arm64/kernels.py names {name}, which src/core/kernels does not have")
    total = Function(name)
    for _, function in functions_of(file, "tT"):
        if function in functions:
            total.add(functions[function])
    return total


def judge(found):
    """Names of the kernels that hardly compute with vectors, or were not executed."""
    return [kernel.name for kernel in found if kernel.share < LEAST_SHARE]
