"""Numbers and tables in Markdown."""

from collections.abc import Sequence

MISSING = "-"


def number(value: float | None) -> str:
    """Three significant digits, no exponent unless it is tiny."""
    if value is None:
        return MISSING
    if value == 0:
        return "0"
    if abs(value) >= 100:
        return f"{value:,.0f}"
    if abs(value) >= 10:
        return f"{value:.1f}"
    return f"{value:.2f}" if abs(value) >= 1 else f"{value:.3g}"


def table(header: Sequence[str], rows: Sequence[Sequence[str]], texts: int = 1) -> str:
    """@param texts  so many columns hold text and are aligned left"""
    align = ["---" if i < texts else "---:" for i in range(len(header))]
    lines = [header, align, *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"
