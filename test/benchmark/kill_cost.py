#!/usr/bin/python3
"""kill_cost.py [KILLS]: cost of kill -9 of the recorder: seconds before the kill that are missing from the rescued bag.

Prints the table of docs/reliability.md: median and worst of KILLS (11) for each rate, with the chunk size that record.launch
chooses. Runs an emulated board, the driver and the recorder, and kills the recorder at a different time in each run. Source
out/devel/setup.bash first.
"""
import os
import pathlib
import random
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time

import rosbag

SETTINGS = [(10, 7, 10), (100, 7, 10), (1000, 16, 10)]  # scans a second, rows, columns


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def cost(folder, programs, start, chunk, number):
    bag = folder / f"killed_{number}.bag"
    active = pathlib.Path(f"{bag}.active")
    recorder = start(programs / "recorder_node", "__name:=recorder", f"_bag:={bag}", "_topics:=/raw", f"_chunk_kb:={chunk}", "_min_space:=1")
    while not active.exists() or active.stat().st_size < 9000 + 3000 * chunk:  # beyond its header
        time.sleep(0.05)
    time.sleep(random.uniform(0, 1))
    recorder.send_signal(signal.SIGKILL)
    killed = time.time()
    recorder.wait()
    with rosbag.Bag(str(active), "a", allow_unindexed=True) as unindexed:
        for _ in unindexed.reindex():
            pass
    with rosbag.Bag(str(active)) as rescued:
        last = max(received.to_sec() for _, _, received in rescued.read_messages(["/raw"]))
    active.unlink()
    return killed - last


def main():
    kills = int(sys.argv[1]) if len(sys.argv) > 1 else 11
    programs = pathlib.Path(os.environ["CMAKE_PREFIX_PATH"].split(":")[0]) / "lib" / "fsr_pressure_map"
    environment = dict(os.environ, ROS_MASTER_URI=f"http://127.0.0.1:{free_port()}", ROS_IP="127.0.0.1")
    children = []

    def start(*command):
        children.append(subprocess.Popen([str(word) for word in command], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        return children[-1]

    print("| scans a second, taxels | chunk [KB] | lost, median (worst) [s] |\n|---|---:|---:|")
    with tempfile.TemporaryDirectory(prefix="fsr_kill_") as name:
        folder = pathlib.Path(name)
        environment["ROS_HOME"] = name
        try:
            start("rosmaster", "--core", "-p", environment["ROS_MASTER_URI"].rsplit(":", 1)[1])
            time.sleep(3)
            for rate, rows, columns in SETTINGS:
                board = [start(programs / "rig_emulator_node", f"_link:={name}/board", f"_scan_rate:={rate}", f"_rows:={rows}", f"_columns:={columns}"),
                         start(programs / "driver_node", f"_serial_port:={name}/board", "_serial_baud:=0")]
                chunk = max(1, rate * (2 * rows * columns + 60) // 2048)
                costs = sorted(cost(folder, programs, start, chunk, number) for number in range(kills))
                for node in board:
                    node.terminate()
                    node.wait()
                print(f"| {rate}, {rows} x {columns} | {chunk} | {statistics.median(costs):.2f} ({costs[-1]:.2f}) |", flush=True)
        finally:
            for child in children:
                child.kill()
                child.wait()


main()
