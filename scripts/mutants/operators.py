"""The kinds of mutants: plausible slips in numeric code, each in one line.

An operator takes a line without comments and texts, and yields changes (start, end, replacement) of that line. The line is
as clang-format leaves it, so that binary operators have blanks around them and templates have none.
"""

import re

from .source_text import argument_end, term_end


def _swaps(pairs):
    """Yields the changes of each pattern's group 1 into its replacement."""
    compiled = [(re.compile(pattern), replacement) for pattern, replacement in pairs]

    def operator(line):
        for pattern, replacement in compiled:
            for match in pattern.finditer(line):
                yield match.start(1), match.end(1), replacement
    return operator


def dropped_term(line):
    """Drops a term or a factor: a + b -> a, and a * b -> a."""
    for match in re.finditer(r"(?<=[\w)\]]) ([-+*]) (?=\S)", line):
        end = term_end(line, match.end())
        if match.group(1) == "*":  # a factor ends where the next factor or term begins
            if end is None or re.match(r" / ", line[end:]):
                continue
        else:  # a term goes on over its factors
            while end is not None and re.match(r" [*/%] ", line[end:]):
                end = term_end(line, end + 3)
        if end is not None:
            yield match.start(), end, ""


def dropped_first_factor(line):
    """Drops the first factor: 0.5 * a -> a."""
    for match in re.finditer(r"(?<![\w.])(\d+(?:\.\d+)?(?:e-?\d+)? \* )(?=\S)", line):
        yield match.start(1), match.end(1), ""


def dropped_function(line):
    """Drops a function: std::sqrt(a) -> (a), std::pow(a, 2) -> (a)."""
    for match in re.finditer(r"std::(?:sqrt|abs|exp|log)(?=\()", line):
        yield match.start(), match.end(), ""
    for match in re.finditer(r"std::pow\(", line):
        end = argument_end(line, match.end())
        if end is not None and line.startswith(", 2)", end):
            yield match.start(), end + 4, f"({line[match.end():end]})"


sign = _swaps([(r"(?<=[\w)\]]) (\+) (?=\S)", "-"), (r"(?<=[\w)\]]) (-) (?=\S)", "+"), (r" (\+=) ", "-="), (r" (-=) ", "+="),
               (r"(?:[(,{] ?|return |= |[?:] )(-)(?=[a-zA-Z(])", "")])
product = _swaps([(r"(?<=[\w)\]]) (\*) (?=\S)", "/"), (r"(?<=[\w)\]]) (/) (?=\S)", "*"), (r" (\*=) ", "/="), (r" (/=) ", "*=")])
comparison = _swaps([(r" (<) ", ">"), (r" (>) ", "<"), (r" (<=) ", ">="), (r" (>=) ", "<="), (r" (==) ", "!="), (r" (!=) ", "==")])
logic = _swaps([(r" (&&) ", "||"), (r" (\|\|) ", "&&"), (r"(?:[( ])(!)(?=[\w(])", ""), (r"\b(true)\b", "false"), (r"\b(false)\b", "true"),
                (r"std::(min)\b", "max"), (r"std::(max)\b", "min")])
field = _swaps([(r"\.(x)\(\)", "y"), (r"\.(y)\(\)", "x"), (r"\.(z)\(\)", "y"), (r"[.>](u)\b(?!\()", "v"), (r"[.>](v)\b(?!\()", "u"),
                (r"\b(cx)\b", "cy"), (r"\b(cy)\b", "cx"), (r"\b(fx)\b", "fy"), (r"\b(fy)\b", "fx"),
                (r"[.>(](left)(?=_|\b)", "right"), (r"[.>(](right)(?=_|\b)", "left"), (r"[.>](width)\b(?!\()", "height"),
                (r"[.>](height)\b(?!\()", "width"), (r"[.>](rows)\b", "cols"), (r"[.>](cols)\b", "rows"),
                (r"[.>](first)\b", "second"), (r"[.>](second)\b", "first"), (r"[\[(](0)[\])]", "1"), (r"[\[(](1)[\])]", "0"),
                (r"\((0, 0)\)", "1, 1"), (r"\((1, 1)\)", "0, 0"), (r"\((0, 1)\)", "0, 0")])

_LEFT_SIDE = r"[A-Za-z_](?:[\w.]|->|::|\[[^\]]*\]|\([^()]*\))*"
_ASSIGNMENT = rf"{_LEFT_SIDE} [-+*/|&]?= [^;]*;"
_STEP = r"(?:\+\+|--)[\w.\[\]]+;"
_CALL = rf"{_LEFT_SIDE}\([^;]*\);"
_STATEMENT = re.compile(rf"^(\s*(?:(?:else )?if \(.*\) |else |for \(.*\) )?)({_ASSIGNMENT}|{_STEP}|{_CALL}|continue;|break;)\s*$")
# What hurries, waits, logs or draws only, and what would be no slip.
_HARMLESS = re.compile(r"^(?:return|throw|delete|using|typedef|static_assert|ROS_|NODELET_|__builtin|std::cerr|std::cout)"
                       r"|\.reserve\(|prefetch|Prefetch")


def dropped_statement(line):
    """Forgets an assignment or a call, a reset for example."""
    match = _STATEMENT.match(line)
    if match and not _HARMLESS.search(match.group(2)):
        yield match.start(2), match.end(2), "{}"


def swallowed_error(line):
    """Forgets the early return of a condition."""
    match = re.match(r"^(\s*)(if \(.*\) (?:return\b[^;]*|throw [^;]*);)\s*$", line)
    if match:
        yield match.start(2), match.end(2), ""


KINDS = {"term": dropped_term, "factor": dropped_first_factor, "function": dropped_function, "sign": sign, "product": product,
         "comparison": comparison, "logic": logic, "field": field, "statement": dropped_statement, "error": swallowed_error}
