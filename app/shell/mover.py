"""Shell: the town mode: feet in, the town on a page, a wall of pages, packets out; on one loop.

`visiting` does the thinking; this file opens, wires, starts and stops.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from os.path import realpath

from app.damage import Damage
from app.door.access import Access
from app.door.front import Door
from app.formats.wire.stream import Counters
from app.gestures.packet import packet_of
from app.gestures.steering import Comfort
from app.gestures.words import standing
from app.home import visitors
from app.home.calibrations import Corrections
from app.motion.basics import InputError, Role, role_of
from app.motion.commands import MoverCommand, Order, RestartHere
from app.motion.samples import Sample
from app.motion.source import Link
from app.outputs.senders import AxesSender, Outlet, PacketSender
from app.scene.mover_page import MoverScene
from app.shell.aside import aside
from app.shell.serving import Desk, open_door
from app.simulate.gestures_options import GestureOptions, parse
from app.sources.opening import open_source
from app.sources.source import Source
from app.sources.spec import parse_spec
from app.visit import LoadVisitor, SaveVisitor, Visit
from app.visiting import Visiting
from app.warm import warm_attitude, warm_gestures
from app.world import make_town

log = logging.getLogger(__name__)

FRAME_S = 1 / 60
#: A place is given so long to leave before words are worked out.
AWAY_S = 0.004
#: After a fault in drawing the next try waits so long.
FAULT_S = 1.0
STILL_S = 0.5
MESSAGE_S = 6.0
#: The walk that OSC calls 1.
FULL_MPS = 2.0
DEFAULT_SOURCE = "sim:gestures"
SIDES = {"left": Role.LEFT, "right": Role.RIGHT}
TILES = {(3, 1): ("left", "centre", "right"), (2, 1): ("left", "right")}


@dataclass(frozen=True)
class Options:
    """What the command line says."""

    source: str | None
    left: str | None
    right: str | None
    decoder: str
    udp: str | None
    osc: str | None
    access: Access
    open_browser: bool
    kiosk: bool
    wall: tuple[int, int] | None


def move(options: Options, tell: Callable[[str], None]) -> None:
    """Serve the town until Ctrl-C. ``tell`` prints a line. Bad input is ``InputError``."""
    with contextlib.ExitStack() as closing:
        mover = Mover(options, closing)
        asyncio.run(mover.serve(tell))


class Feed:
    """One source, and whose samples it brings: of one foot where a side is given, else by their names."""

    def __init__(self, source: Source, side: str | None) -> None:
        self.source, self.side = source, side
        self._corrections = Corrections(lambda: source.info)

    def named(self, sample: Sample) -> Sample:
        """The sample as its sensor was calibrated, under its side's name."""
        sample = self._corrections.apply(sample)
        return sample if self.side is None else sample._replace(sensor=self.side)

    def counters(self) -> dict[str, Counters]:
        """What the line did to each sensor's packets, under its side's name."""
        return {self.side or sensor: kept for sensor, kept in self.source.counters.items()}


def live_options(options: Options) -> GestureOptions | None:
    """Simulated feet that are steered, where no script is given; None for any other source."""
    if options.left or options.right:
        return None
    spec = parse_spec(options.source or DEFAULT_SOURCE)
    if (spec.kind, spec.target) != ("sim", "gestures") or "script" in spec.options:
        return None
    return parse(spec.options)


def open_feeds(options: Options) -> list[Feed]:
    """The sensors' sources; none where the feet are steered."""
    if live_options(options) is not None:
        return []
    if options.left or options.right:
        if options.source or not (options.left and options.right):
            raise InputError("expected --source alone, or both --left and --right")
        demand_two_ports(options.left, options.right)
        return [Feed(with_sensors(open_source(spec, changes=False), side), side) for side, spec in
                (("left", options.left), ("right", options.right))]  # fmt: skip
    return [Feed(with_sensors(open_source(options.source or DEFAULT_SOURCE, changes=False), None), None)]


def with_sensors(source: Source, side: str | None) -> Source:
    """The source, if it is live or a recording of what is wanted: both feet, or one for a side."""
    held = set(source.info.sensors.values())
    if source.info.duration_s is None:
        return source
    came = f"{source.info.name}: {', '.join(source.info.sensors) or 'no sensor'}"
    if side is not None and len(source.info.sensors) != 1:
        raise InputError(f"--{side} {came}: expected one sensor, tell which: ?foot={side}")
    if side is None and not {Role.LEFT, Role.RIGHT} <= held:
        raise InputError(f"--source {came}: expected the sensors left and right")
    return source


def demand_two_ports(left: str, right: str) -> None:
    """One serial port is one sensor, under whatever names; ``InputError`` otherwise."""
    specs = parse_spec(left), parse_spec(right)
    if {spec.kind for spec in specs} == {"serial"} and len({realpath(spec.target) for spec in specs}) == 1:
        raise InputError(f"--left and --right are both {specs[0].target}: expected a port for each foot")


def waiting(feeds: Sequence[Feed]) -> str:
    """What the sources that bring nothing say of themselves: what is being tried, or what is wrong."""
    idle = [feed for feed in feeds if feed.source.link is not Link.LIVE and feed.source.detail]
    return "; ".join(
        f"{feed.side} foot: {feed.source.detail}" if feed.side else feed.source.detail for feed in idle
    )


def addresses(operate: str, watch: str, options: Options) -> list[str]:
    """What else can be opened: full windows, a wall's tiles, the operator's page.

    ``operate`` and ``watch`` are the addresses for either; what hangs on a wall shows and moves nothing.
    """
    lines = [f"  without the panel   {asking(watch)}kiosk=1"]
    if options.kiosk:
        lines = [f"  operator's page     {asking(operate)}operator=1"]
    if options.wall is not None:
        columns, rows = options.wall
        names = TILES.get(options.wall) or [f"{c},{r}" for r in range(rows) for c in range(columns)]
        lines += [f"  wall, {name:<13} {asking(watch)}tile={name}&fixedDpr=1" for name in names]
    return lines


def asking(address: str) -> str:
    """An address to which ``key=value`` can be joined."""
    return address + ("&" if "?" in address else "/?")


class Mover:
    """One town being walked."""

    def __init__(self, options: Options, closing: contextlib.ExitStack) -> None:
        self._options, self._closing = options, closing
        self._feeds = open_feeds(options)
        for feed in self._feeds:
            closing.callback(feed.source.close)
        self._visiting = Visiting(
            make_town(), role_of=self._role, name=self._name(), decoder=options.decoder,
            simulated=live_options(options),
        )  # fmt: skip
        self._senders = self._open_senders()
        self._desk = Desk()
        self._damage = Damage()
        self._news = asyncio.Event()  # the feet, or a person, ask for something else
        self._moved = asyncio.Event()  # a place has just left
        self._well_again_s = 0.0
        self._message_until = 0.0
        self._visit: Visit | None = None

    async def serve(self, tell: Callable[[str], None]) -> None:
        """Open the page, then everything else."""
        self._desk.open()
        scene = MoverScene(
            self._desk.submit,
            self._visiting.town,
            wall=self._options.wall or (3, 1),
            kiosk=self._options.kiosk,
        )
        self._closing.callback(scene.close)
        door = Door(
            self._options.access, viser_port=scene.port, rules=scene.rules, health=self._health,
            extra_head=scene.head,
        )  # fmt: skip
        self._closing.callback(door.stop)
        open_door(
            door, tell, self._options.open_browser,
            lambda: addresses(door.address, door.watching, self._options),
        )  # fmt: skip
        await self._desk.until_stopped([self._run(scene)])

    async def _run(self, scene: MoverScene) -> None:
        """Everything at once, until cancelled. A source that ends is silent from then on."""
        still = asyncio.create_task(self._stand_still(scene))
        await aside(warm_gestures, "prepare")
        attitude = asyncio.create_task(aside(warm_attitude, "prepare"))  # for who chooses the papers' decoder
        if self._options.decoder == "papers":
            await attitude
        still.cancel()
        self._visiting.visitors = visitors.names()
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._draw(scene))
            tasks.create_task(self._speak(scene))
            tasks.create_task(self._obey())
            for feed in self._feeds:
                tasks.create_task(self._acquire(feed))

    async def _stand_still(self, scene: MoverScene) -> None:
        """Again and again: a page that hears nothing for long says that the program is gone."""
        while True:
            scene.draw(
                self._visiting.still(time.monotonic_ns(), "Preparing the feet (slow only the first time)")
            )
            await asyncio.sleep(STILL_S)

    # --- in ---------------------------------------------------------------------------------------

    async def _acquire(self, feed: Feed) -> None:
        async for item in feed.source:
            if isinstance(item, RestartHere):
                self._visiting.begin_anew()
            elif isinstance(item, Sample):
                self._visiting.take(feed.named(item))
                if self._visiting.news:
                    self._news.set()

    async def _obey(self) -> None:
        while True:
            order = await self._desk.orders.get()
            try:
                self._take(order)
            except InputError as error:
                self._say(str(error))

    def _take(self, order: Order) -> None:
        match order.command:
            case SaveVisitor(name):
                visitors.save(name, self._visiting.kept())
                self._visiting.visitors = visitors.names()
                self._say(f"visitor {name} saved")
            case LoadVisitor(name):
                self._visiting.use(visitors.load(name))
                self._say(f"visitor {name}: thresholds as before")
            case MoverCommand() as command:
                self._visiting.obey(command, time.monotonic_ns())
                self._news.set()  # a stop is not left to wait either

    def _role(self, sensor: str) -> Role:
        if sensor in SIDES:
            return SIDES[sensor]
        told = (feed.source.info.sensors.get(sensor) for feed in self._feeds)
        return next((role for role in told if role is not None), role_of(sensor))

    def _name(self) -> str:
        return " and ".join(feed.source.info.name for feed in self._feeds) or "simulated feet"

    # --- out --------------------------------------------------------------------------------------

    async def _draw(self, scene: MoverScene) -> None:
        """Sixty places a second, and one more as soon as the feet ask for something else."""
        due = time.monotonic()
        while True:
            self._carefully(self._move, scene)
            self._moved.set()
            due = max(due + FRAME_S, time.monotonic())
            if await self._news_before(due):
                self._carefully(self._move, scene)
                await asyncio.sleep(max(0.001, due - time.monotonic()))

    async def _news_before(self, due: float) -> bool:
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(max(0.001, due - time.monotonic())):
                return await self._news.wait()
        return False

    def _move(self, scene: MoverScene) -> None:
        """Decide and go: the place leaves before anything else is worked out."""
        self._news.clear()
        now_ns = time.monotonic_ns()
        self._visiting.decide(now_ns)
        walker, eye_m = self._visiting.go(now_ns)
        scene.move(walker.north, walker.east, walker.heading_rad, eye_m)
        self._send(now_ns * 1e-9)

    async def _speak(self, scene: MoverScene) -> None:
        """Words, figures and graphs, after a place has left and well before the next."""
        while True:
            await self._moved.wait()
            self._moved.clear()
            if scene.due:
                await asyncio.sleep(AWAY_S)  # viser's and the door's threads have the machine first
                self._carefully(self._tell, scene)

    def _tell(self, scene: MoverScene) -> None:
        if self._message_until and time.monotonic() > self._message_until:
            self._say("")
        feet = {self._role(name): kept for feed in self._feeds for name, kept in feed.counters().items()}
        self._visiting.trouble = self._damage.told(feet, time.monotonic()) or waiting(self._feeds)
        self._visit = self._visiting.look(time.monotonic_ns())
        scene.tell(self._visit)

    def _carefully(self, show: Callable[[MoverScene], None], scene: MoverScene) -> None:
        """A fault in drawing is logged, not too often, and never ends the visit."""
        if time.monotonic() < self._well_again_s:
            return
        try:
            show(scene)
        except Exception:
            log.exception("drawing failed")
            self._well_again_s = time.monotonic() + FAULT_S

    def _send(self, now_s: float) -> None:
        packets, axes = self._senders
        if packets is not None:
            packets.tell(packet_of(self._visiting.decision), now_s)
        if axes is not None:
            walker, most = self._visiting.walker, Comfort()
            axes.tell(
                walker.ahead_mps / FULL_MPS,
                walker.right_mps / FULL_MPS,
                walker.turn_radps / most.most_radps,
                now_s,
            )

    def _open_senders(self) -> tuple[PacketSender | None, AxesSender | None]:
        packets = axes = None
        if self._options.udp:
            packets = PacketSender(Outlet(self._options.udp, "--udp"), packet_of(standing(0, "")))
            self._closing.callback(packets.close)
        if self._options.osc:
            axes = AxesSender(Outlet(self._options.osc, "--osc"))
            self._closing.callback(axes.close)
        return packets, axes

    def _say(self, message: str) -> None:
        self._visiting.message = message
        self._message_until = time.monotonic() + MESSAGE_S if message else 0.0

    def _health(self) -> dict[str, object]:
        """For /healthz; read on the door's thread, so only what is one read."""
        visit = self._visit
        if visit is None:
            return {"link": "starting"}
        return {"link": visit.fault or "live", "motion": visit.motion.name.lower(), "found": visit.score}
