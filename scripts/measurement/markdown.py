"""Numbers as cells of markdown tables."""

DASH = "–"


def number(value, form, factor=1):
    """A number in this format, a dash when there is none."""
    return DASH if value is None else format(factor * value, form)


def line(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def table(header, rows):
    """A whole table; all rows must have the header's number of cells."""
    for row in rows:
        if len(row) != len(header):
            raise ValueError(f"{len(row)} cells under {len(header)} headings: {row}")
    return "\n".join([line(*header), "|" + "---|" * len(header), *(line(*row) for row in rows)]) + "\n"
