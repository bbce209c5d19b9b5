"""A conducted day at the emulated rig, for scripts/demo --day: an operator follows the conductor through a plan.

Nothing is called between the three launch files and the report of the day."""
import contextlib
import pathlib
import shutil
import threading

from demo_tools import Failure, process, run_tool, serves, wait_until

NAMESPACE = "fsr"
MINUTES = 45          # of rig time that the plan may take
REPORT = 900          # that check_bag, train and discrepancy may take for the report [s]
SURFACES = pathlib.Path(__file__).resolve().parent.parent / "config/surfaces"


class Listener:
    """Hears what the conductor says."""

    def __init__(self, say):
        import rospy
        from fsr_pressure_map.msg import Instruction
        self.say, self.over, self.step, self.remark = say, threading.Event(), None, ""
        self.reported = threading.Event()
        self.mount, self.done = Instruction.MOUNT, Instruction.DONE
        rospy.init_node("demo", disable_signals=True)
        rospy.Subscriber(f"/{NAMESPACE}/instruction", Instruction, self.hear)

    def hear(self, instruction):
        if instruction.remark and instruction.remark != self.remark:
            self.say(f"step {instruction.step} of {instruction.steps}: {instruction.remark}")
        self.remark = instruction.remark
        if instruction.step != self.step and instruction.kind in (self.mount, self.done):
            self.say(f"step {instruction.step} of {instruction.steps}: {instruction.text}")
        self.step = instruction.step
        if instruction.kind == self.done:
            self.over.set()
            if instruction.remark and "being written" not in instruction.remark:
                self.reported.set()


def launch(stack, logs, name, *arguments):
    log = logs / f"{name}.log"
    return stack.enter_context(process(["roslaunch", "fsr_pressure_map", f"{name}.launch", *arguments], log)), log


def record(arguments, output, logs, plan, minutes, say):
    """The operator works through the plan. Returns the folder of the bags."""
    folder, board = output / "session", output / "board"
    shutil.rmtree(folder, ignore_errors=True)
    with contextlib.ExitStack() as stack:
        rig, log = launch(stack, logs, "rig_emulator", f"link:={board}", f"time_scale:={arguments.time_scale}", f"seed:={arguments.seed}",
                          "operator:=true")
        wait_until(board.exists, rig, "the rig", log)
        listener = Listener(say)
        launch(stack, logs, "driver", f"serial_port:={board}")
        session, log = launch(stack, logs, "session", f"plan:={plan}", f"folder:={folder}", f"surfaces:={SURFACES}")
        wait_until(lambda: serves(f"/{NAMESPACE}/conduct/confirm"), session, "the conductor", log)
        if not listener.over.wait(60 + 60 * (minutes + 30) / arguments.time_scale):
            raise Failure(f"the session did not end: step {listener.step}, {listener.remark or 'no remark'}; its log is {log}")
        if not listener.reported.wait(REPORT):
            raise Failure(f"the report of the day was not written; the log is {log}")
    return folder


def run(arguments, output, logs, say):
    """The whole day. Raises Failure where it cannot go on."""
    plan = output / "day.yaml"
    run_tool(logs / "plan.log", "plan_session", "--for", "per_curvature", "--minutes", MINUTES, "--output", plan)
    say(f"planned {plan}; an operator follows the conductor at {arguments.time_scale:g} x real time")
    folder = record(arguments, output, logs, plan, MINUTES, say)
    report, calibration, results = folder / "day_report.html", folder / "day_calibration.h5", folder / "day_report"
    if not report.exists():
        raise Failure(f"{report} is missing; the logs are in {logs} and {results}")
    for tool in ("check_bag", "train", "discrepancy"):
        print((results / f"{tool}.txt").read_text())
    print(f"plan         {plan}")
    print("bags         " + "\n             ".join(map(str, sorted(folder.glob("*.bag")))))
    print(f"calibration  {calibration if calibration.exists() else 'none, see the report'}")
    print(f"report       {report}")
