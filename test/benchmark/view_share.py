#!/usr/bin/python3
"""view_share.py [ROWS COLUMNS RATE SECONDS]: CPU share of the view node with all its outputs subscribed.

Publishes changing maps of ROWS x COLUMNS (16 x 10) at RATE (100 Hz) on a roscore of its own, subscribes to every
output, then reads the view node's CPU time from /proc over SECONDS (20). Start it from a sourced devel space.
"""
import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client

OUTPUTS = ["points", "surface", "image", "statistics", "centre_of_pressure"]


@contextlib.contextmanager
def running(*command):
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        yield child
    finally:
        child.send_signal(signal.SIGINT)
        child.wait()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return str(probe.getsockname()[1])


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def example_map(rows, columns, step):
    import rospy
    from fsr_pressure_map.msg import PressureMap
    message = PressureMap(state=0, rows=rows, columns=columns, pitch_x=0.01, pitch_y=0.01, scheme="per_curvature")
    message.header.frame_id = "fsr_matrix"
    message.header.stamp = rospy.Time.now()
    message.pressure = [2e3 * ((i * 7 + step) % 300) for i in range(rows * columns)]
    message.deviation = [1e4] * (rows * columns)
    message.flags = [0] * (rows * columns)
    return message


def measure(rows, columns, rate, seconds):
    import rosgraph
    import rospy
    from fsr_pressure_map.msg import PressureMap, SurfaceCurvature
    rospy.init_node("view_share", disable_signals=True)
    counts = dict.fromkeys(OUTPUTS, 0)

    def counter(output):
        def count(_):
            counts[output] += 1
        return count

    listeners = [rospy.Subscriber(f"/fsr/{output}", rospy.AnyMsg, counter(output)) for output in OUTPUTS]
    maps = rospy.Publisher("/fsr/pressure_map", PressureMap, queue_size=10)
    surface = rospy.Publisher("/fsr/curvature", SurfaceCurvature, queue_size=1, latch=True)
    surface.publish(SurfaceCurvature(surface="cylinder_7cm", x=[1 / 0.07]))
    messages = [example_map(rows, columns, step) for step in range(50)]
    pid = None
    started, sent, cpu = None, 0, 0.0
    while started is None or time.monotonic() - started < seconds:
        message = messages[sent % 50]
        message.header.stamp = rospy.Time.now()
        maps.publish(message)
        sent += 1
        if started is None and all(counts.values()):
            node = rosgraph.Master("/view_share").lookupNode("/fsr/view")
            pid = xmlrpc.client.ServerProxy(node).getPid("/view_share")[2]
            counts.update(dict.fromkeys(OUTPUTS, 0))
            started, sent, cpu = time.monotonic(), 0, cpu_seconds(pid)
        time.sleep(max(0.0, (started + sent / rate - time.monotonic()) if started else 1 / rate))
    span = time.monotonic() - started
    share = (cpu_seconds(pid) - cpu) / span
    flows = ", ".join(f"{output} {count / span:.0f} Hz" for output, count in counts.items())
    print(f"{rows} x {columns}, {sent / span:.0f} maps a second: view {100 * share:.1f} % of a core ({flows})")
    del listeners


def main():
    rows, columns, rate, seconds = (list(map(float, sys.argv[1:])) + [16, 10, 100, 20][len(sys.argv) - 1:])
    port = free_port()
    os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1")
    with running("roslaunch", "-p", port, "fsr_pressure_map", "view.launch"):
        while True:
            import rosgraph
            if rosgraph.is_master_online():
                break
            time.sleep(0.1)
        measure(int(rows), int(columns), rate, seconds)


main()
