"""How long until a browser shows the arm: ``python -m benchmarks.first_picture``.

A fresh Python builds a robot and its view; a headless Chromium that is already running, without
a GPU, opens the page. The clock starts when the import has ended and stops at the first look, one
every 50 ms, at which the page's picture is opaque and has the arm's dark joints in it. Needs
playwright and Debian's ``chromium``.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from statistics import median
from typing import Any

RUNS = 5
ARGUMENTS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]
SERVE = """
import sys, time
import dh2urdf
times = [time.time()]
robot = dh2urdf.Robot.from_dh("ur5e")
times.append(time.time())
view = robot.view([0.35, -1.83, 1.45, -0.89, -1.24, 0.38], port=0)
times.append(time.time())
print(*times, view.url, flush=True)
sys.stdin.readline()
view.stop()
"""
WATCH = """(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    let scene = null, panel = null;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        if (kind.startsWith("webgl")) scene = this;
        return original.call(this, kind, ...rest);
    };
    const small = document.createElement("canvas");
    [small.width, small.height] = [48, 32];
    const ink = small.getContext("2d", { willReadFrequently: true });
    const now = () => performance.timeOrigin + performance.now();
    const dark = () => {
        ink.clearRect(0, 0, 48, 32);
        ink.drawImage(scene, 0, 0, 48, 32);
        const seen = ink.getImageData(0, 0, 48, 32).data;
        let count = 0;
        for (let k = 0; k < seen.length; k += 4)
            if (seen[k + 3] > 200 && seen[k] < 140 && seen[k + 2] < 190) count += 1;
        return count;
    };
    window.picture = new Promise(done => {
        const look = () => {
            if (panel === null && document.querySelector("[role=tab]")) panel = now();
            const shown = scene && scene.isConnected && scene.width;
            if (shown && Number(scene.style.opacity || 1) > 0.9 && dark() >= 8)
                done([panel, now()]);
            else setTimeout(look, 50);
        };
        look();
    });
})()"""


def first_picture(browser: Any) -> dict[str, float]:
    """Seconds from the end of the import to each step of one view."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    page.add_init_script(WATCH)
    page.goto("about:blank")
    pipe = subprocess.PIPE
    command = [sys.executable, "-c", SERVE]
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as served:
        assert served.stdout is not None
        *times, url = served.stdout.readline().split()
        start, robot, view = (float(t) for t in times)
        page.goto(url, wait_until="commit")
        panel, picture = (t / 1000.0 for t in page.evaluate("window.picture"))
        context.close()
        served.communicate("\n")
    ends = {"robot": robot, "server": view, "panel": panel, "picture": picture}
    return {name: end - start for name, end in ends.items()}


def main() -> None:
    """Print the median of some runs and their spread, with the load they were met by."""
    from playwright.sync_api import sync_playwright

    found = shutil.which("chromium")
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=found, args=ARGUMENTS)
        runs = [first_picture(browser) for _ in range(RUNS)]
        browser.close()
    print(f"seconds after the import, {RUNS} runs, load {os.getloadavg()[0]:.1f}")
    for name in runs[0]:
        taken = sorted(run[name] for run in runs)
        print(f"{name:8s} median {median(taken):.2f}   {taken[0]:.2f} to {taken[-1]:.2f}")


if __name__ == "__main__":
    main()
