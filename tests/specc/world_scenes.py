"""A run by hand, as pictures draw it: one robot drives along x, pushes a crate and is stuck."""

from dataclasses import replace

import numpy as np

from runtime.world.model import Disc, Polygon, Shape
from specc.figures.scene import NOBODY, Glow, Item, Lamp, Mark, Outcome, Scene, Trails

SQUARE = Shape((), (Polygon(((-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1))),))
ROUND = Shape((Disc(0.0, 0.0, 0.12),), ())


def scene(*, lit: bool = True) -> Scene:
    xs, ys = np.linspace(0.05, 3.95, 40), np.linspace(0.05, 1.95, 20)
    lux = 5.0 / ((xs[None, :] - 3.5) ** 2 + (ys[:, None] - 1.0) ** 2 + 0.2)
    return Scene(
        title="drive",
        about="One robot drives along a corridor.",
        seed=3,
        arena=np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]]),
        things=(Item("desk", SQUARE, is_fixed=True), Item("crate", SQUARE)),
        robots=(Item("r", ROUND),),
        lamps=(Lamp("bulb", 3.5, 1.0), Lamp("torch", 0.0, 0.1, on=1)),
        glow=Glow(xs, ys, np.array([0.0, 5.0]), np.array([0.5 * lux, lux])) if lit else None,
    )


def trails(seconds: float = 12.0, rate: float = 50.0) -> Trails:
    times = np.arange(round(seconds * rate) + 1) / rate
    count = len(times)
    x = 0.3 + 2.0 * times / seconds
    robots = np.zeros((count, 1, 3))
    robots[:, 0, 0], robots[:, 0, 1] = x, 1.0 + 0.2 * np.sin(times)
    things = np.zeros((count, 2, 3))
    things[:, 0, :2] = 1.0, 1.8
    things[:, 1, 0], things[:, 1, 1] = np.maximum(1.5, x + 0.22), 1.0
    acting = np.full((count, 1), NOBODY)
    acting[count // 4 :] = 0
    acting[count // 2 :] = 1
    return Trails(
        times=times,
        things=things,
        robots=robots,
        doers=(("seek", "avoid"),),
        acting=acting,
        contacts=(Mark(0, 6.0, 1.3, 1.0), Mark(0, 6.1, 1.302, 1.0)),
        jams=(Mark(0, 10.0, 1.9, 1.0, 12.0),),
        outcomes=(
            Outcome("always r.clearance > 1 cm", holds=False, margin="1 cm"),
            Outcome("eventually r.x > 2 m", holds=True),
        ),
    )


def a_run(seed: int, robots: int, things: int) -> tuple[Scene, Trails]:
    """Robots and things anywhere in a hall; robots go to and fro, and things are pushed."""
    chance = np.random.default_rng(seed)
    drawn, way = scene(lit=False), trails()
    count = len(way.times)
    poses = chance.uniform((0.2, 0.2, -3.0), (3.8, 1.8, 3.0), (2, robots + things, 3))
    share = np.linspace(0.0, 1.0, count)[:, None, None]
    all_poses = poses[0] + share * (poses[1] - poses[0])
    shapes = [Item(f"crate_{i}", SQUARE, is_fixed=bool(i % 2)) for i in range(things)]
    names = [Item(f"robot_{i}", ROUND) for i in range(robots)]
    return (
        replace(drawn, things=tuple(shapes), robots=tuple(names), lamps=drawn.lamps[:1]),
        replace(
            way,
            things=all_poses[:, robots:],
            robots=all_poses[:, :robots],
            doers=way.doers * robots,
            acting=np.tile(way.acting, (1, robots)),
        ),
    )
