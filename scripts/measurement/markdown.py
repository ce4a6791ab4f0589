"""Writes numbers as cells of markdown tables."""

DASH = "–"


def number(value, form, factor=1):
    """Writes a number in this format, or a dash when there is none."""
    return DASH if value is None else format(factor * value, form)


def line(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def table(header, rows):
    """Writes a whole table. All rows must have as many cells as the header."""
    for row in rows:
        if len(row) != len(header):
            raise ValueError(f"{len(row)} cells under {len(header)} headings: {row}")
    return "\n".join([line(*header), "|" + "---|" * len(header), *(line(*row) for row in rows)]) + "\n"
