"""The machine that Tapreach runs on: its Wi-Fi and its disk."""

import shutil
from dataclasses import dataclass
from pathlib import Path

from tapreach.cli.checkup.check import Check, Verdict, graded

WIRELESS = Path("/proc/net/wireless")
WEAK_DBM, TOO_WEAK_DBM = -70.0, -82.0
LITTLE_MB, TOO_LITTLE_MB = 2000, 200
"""An hour of recording takes one to two gigabytes."""
LEGACY_DBM_OFFSET = 256
"""Some drivers give the level as a byte: 200 is -56 dBm."""


@dataclass(frozen=True, slots=True)
class Signal:
    """One wireless interface and how strongly it hears its access point [dBm]."""

    interface: str
    level_dbm: float


def read_signals(text: str) -> list[Signal]:
    """Return what a /proc/net/wireless says; lines that are none are left out."""
    signals = []
    for line in text.splitlines()[2:]:
        name, colon, rest = line.partition(":")
        words = rest.split()
        try:
            level = float(words[2].rstrip("."))
        except (IndexError, ValueError):
            continue
        if colon:
            signals.append(Signal(name.strip(), level - LEGACY_DBM_OFFSET if level > 0 else level))
    return signals


def check_wifi(needs_network: bool, wireless: Path = WIRELESS) -> Check:
    """Look at the strongest signal; `needs_network`: the robot's camera or board is behind a network."""
    signals = read_signals(wireless.read_text(encoding="ascii")) if wireless.is_file() else []
    heard = [signal for signal in signals if signal.level_dbm < 0]
    if not heard:
        found = "connected to none" if signals else "this machine has none"
        if needs_network:
            advice = "if the robot is reached by cable, all is well; else join its network"
            return Check("wifi", Verdict.WARN, found, advice)
        return Check("wifi", Verdict.OK, f"{found}; the robot needs none")
    best = max(heard, key=lambda signal: signal.level_dbm)
    verdict = graded(best.level_dbm, WEAK_DBM, TOO_WEAK_DBM)
    advice = "" if verdict is Verdict.OK else "weak: go nearer, take the 2.4 GHz band, or an aerial outside"
    figures: dict[str, float | str] = {"signal_dbm": best.level_dbm, "interface": best.interface}
    return Check("wifi", verdict, f"{best.interface}: {best.level_dbm:.0f} dBm", advice, figures)


def check_disk(folder: Path) -> Check:
    """Look at the disk that recordings and captures in `folder` go to; the folder need not be there yet."""
    there = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    free_mb = shutil.disk_usage(there).free // 1_000_000
    verdict = graded(free_mb, LITTLE_MB, TOO_LITTLE_MB)
    advice = "" if verdict is Verdict.OK else f"free some space on the disk of {there.absolute()}"
    return Check("disk", verdict, f"{free_mb / 1000:.1f} GB free", advice, {"free_mb": free_mb})
