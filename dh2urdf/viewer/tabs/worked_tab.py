"""The worked solution of the pose at which the arm stands: a step chosen is drawn and said."""

from collections.abc import Callable
from html import escape
from typing import Any

from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.lessons import IKExplanation, Mark, Step
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.viewer.door import by_visitor
from dh2urdf.viewer.tabs import html

NOTHING = "none"

WAYS = {"‹ Previous": -1, "Next ›": 1}
"""Buttons that go step by step."""

HINT = (
    "Choose a step, or Next: inverse kinematics of the pose at which the arm stands, as the "
    "lecture notes do it, with this arm's numbers. Move the arm, and the numbers follow."
)


class WorkedTab:
    """Says and chooses steps; ``on_step`` is called when another one is to be drawn."""

    def __init__(self, gui: Any, tab: Any, on_step: Callable[[], None]) -> None:
        self.on_step = on_step
        self.told: IKExplanation | None = None
        self.step = 0
        with tab:
            self.choice = gui.add_dropdown("Step", (NOTHING,), initial_value=NOTHING)
            self.walk = gui.add_button_group("Steps", tuple(WAYS))
            self.words = gui.add_html(html.message(HINT))
        self.choice.on_update(by_visitor(self._chosen))
        self.walk.on_click(by_visitor(self._walked))

    def build(self, robot: Robot) -> None:
        """Prepare for another arm."""
        self.robot, self.told = robot, None
        self.put_away()

    def put_away(self) -> None:
        """Choose no step."""
        self.step = 0
        self.choice.value = NOTHING
        self.words.content = html.message(HINT)

    def show(self, q: Array) -> tuple[Mark, ...]:
        """Follow the arm to q (n,); what the step chosen draws."""
        if not self.step:
            return ()
        try:
            T = self.robot.fk(q)
            self.told = self.robot.explain_ik(T, seed=q, within_limits=False)
        except Dh2UrdfError as error:
            self.words.content = html.message(str(error), "bad")
            return ()
        self._list()
        step = self.told.steps[self.step - 1]
        self.words.content = step_html(step)
        return step.marks

    def _list(self) -> None:
        """Name the steps of this pose, which a singular one has others of."""
        assert self.told is not None
        titles = [f"{i}. {step.title}" for i, step in enumerate(self.told.steps, 1)]
        self.step = min(self.step, len(titles))
        if tuple(self.choice.options) != (NOTHING, *titles):
            self.choice.options = (NOTHING, *titles)
        if self.choice.value != titles[self.step - 1]:
            self.choice.value = titles[self.step - 1]

    def _chosen(self, _: Any) -> None:
        options = list(self.choice.options)
        self.step = options.index(self.choice.value)
        if not self.step:
            self.put_away()
        self.on_step()

    def _walked(self, _: Any) -> None:
        last = len(self.told.steps) if self.told else 1
        self.step = min(max(self.step + WAYS[self.walk.value], 0), max(last, 1))
        if not self.step:
            self.put_away()
        self.on_step()


def step_html(step: Step) -> str:
    """Words, plot and equations of a step."""
    code = f"{html.CODE};{html.STYLE}margin:0;font-size:11px"
    texts = [step.curve.text] if step.curve else []
    texts += [equation.text for equation in step.equations]
    shown = (f'<pre style="{code}">{escape(text)}</pre>' for text in texts)
    return "".join([html.message(step.words.replace("`", "")), *shown])
