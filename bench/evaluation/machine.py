"""Describes the machine, the compiler and the sources."""

import datetime
import os
import platform
import subprocess
from pathlib import Path

from evaluation.plan import FULL_TEXT, QUICK_TEXT


def _field(path: str, key: str) -> str:
    """The value of the first line "KEY : VALUE" of a file of /proc."""
    try:
        for line in Path(path).read_text(encoding="utf-8").splitlines():
            name, _, value = line.partition(":")
            if name.strip() == key:
                return value.strip()
    except OSError:
        pass
    return ""


def _output(*command: str) -> str:
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def _cached(build: Path, key: str) -> str:
    """A variable of the CMake cache."""
    for line in (build / "CMakeCache.txt").read_text(encoding="utf-8").splitlines():
        if line.startswith(key + ":"):
            return line.partition("=")[2]
    return ""


def _memory() -> str:
    kibibytes = _field("/proc/meminfo", "MemTotal").split()
    return f"{int(kibibytes[0]) / 2**20:.0f} GiB" if kibibytes else "unknown"


def _huge_pages() -> str:
    """The setting in force, e.g. madvise of "always [madvise] never"."""
    try:
        text = Path("/sys/kernel/mm/transparent_hugepage/enabled").read_text(encoding="utf-8")
    except OSError:
        return "unknown"
    return text.partition("[")[2].partition("]")[0] or "unknown"


def _compiler(build: Path) -> str:
    lines = _output(_cached(build, "CMAKE_CXX_COMPILER"), "--version").splitlines()
    return lines[0] if lines else "unknown"


def _sources() -> str:
    commit = _output("git", "rev-parse", "--short", "HEAD")
    if not commit:
        return "unknown"
    changed = _output("git", "status", "--porcelain", "--", "src", "include", "bench")
    return f"commit {commit}" + (" with changes" if changed else "")


def describe(build: Path, quick: bool) -> dict[str, str]:
    """Rows of a table, in order."""
    return {
        "date": datetime.date.today().isoformat(),
        "processor": _field("/proc/cpuinfo", "model name") or platform.processor() or "unknown",
        "cores": str(os.cpu_count() or 1),
        "memory": _memory(),
        "huge pages": _huge_pages(),
        "system": f"{platform.system()} {platform.machine()}",
        "compiler": _compiler(build),
        "build": _cached(build, "CMAKE_BUILD_TYPE"),
        "sources": _sources(),
        "load at the start": f"{os.getloadavg()[0]:.1f}",
        "evaluation": QUICK_TEXT if quick else FULL_TEXT,
    }
