#!/usr/bin/python3
"""cpu_share.py ROWS COLUMNS RATE CALIBRATION|none [SECONDS [SIMULATION]]: CPU share of emulator, driver and calibration node.

Starts an emulated board of that size and scan rate [Hz] in real time, with driver, curvature and calibration node on its own
roscore. Waits until maps are published, then reads the CPU time of each process from /proc over SECONDS (20). With `none`
a calibration of this size is first recorded at 20 times real time and trained. SIMULATION is the full path of the emulated
rig; all_effects.yaml in this folder has every effect.
"""
import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time

NODES = ["rig_emulator", "driver", "calibration"]


@contextlib.contextmanager
def running(*command):
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        yield child
    finally:
        child.send_signal(signal.SIGINT)
        child.wait()


def new_master():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1")
    return str(port)


def first_line(*command):
    return subprocess.run(command, capture_output=True, text=True, timeout=120).stdout.splitlines()[:1]


def recorded_calibration(folder, rows, columns):
    with running("roslaunch", "-p", new_master(), str(folder / "rig.launch"), f"rows:={rows}", f"columns:={columns}",
                 "rate:=10", "scale:=20", f"bag:={folder}/train"):
        while "done" not in "".join(first_line("rostopic", "echo", "-n", "1", "/fsr/rig_emulator/status")):
            time.sleep(0.2)
    subprocess.run(["rosrun", "fsr_pressure_map", "train", f"{folder}/train.bag", "--output", f"{folder}/c.h5"], check=True,
                   stdout=subprocess.DEVNULL)
    return f"{folder}/c.h5"


LAUNCH = """<launch>
  <arg name="rows"/> <arg name="columns"/> <arg name="rate"/> <arg name="scale" default="1"/>
  <arg name="bag" default=""/> <arg name="calibration" default=""/> <arg name="simulation" default=""/>
  <param if="$(eval scale != 1)" name="/use_sim_time" value="true"/>
  <group ns="fsr">
    <node pkg="fsr_pressure_map" type="rig_emulator_node" name="rig_emulator">
      <param name="rows" value="$(arg rows)"/> <param name="columns" value="$(arg columns)"/>
      <param name="scan_rate" value="$(arg rate)"/> <param name="time_scale" value="$(arg scale)"/>
      <param name="chamber/cycles" value="$(eval 5 if bag else 0)"/> <param name="link" value="FOLDER/port"/>
      <param if="$(eval simulation != '')" name="simulation" value="$(arg simulation)"/>
    </node>
    <node pkg="fsr_pressure_map" type="driver_node" name="driver">
      <param name="serial_port" value="FOLDER/port"/> <param name="serial_baud" value="0"/>
    </node>
    <node pkg="fsr_pressure_map" type="curvature_node" name="curvature"> <param name="surface" value="flat"/> </node>
    <node if="$(eval calibration != '')" pkg="fsr_pressure_map" type="calibration_node" name="calibration">
      <param name="calibration" value="$(arg calibration)"/>
    </node>
    <node if="$(eval bag != '')" pkg="fsr_pressure_map" type="recorder_node" name="record">
      <param name="bag" type="str" value="$(arg bag)"/>
      <param name="topics" value="/fsr/raw /fsr/chamber_pressure /fsr/curvature /fsr/matrix_info"/>
    </node>
  </group>
</launch>
"""


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    rows, columns, rate, calibration = sys.argv[1:5]
    seconds = float(sys.argv[5]) if len(sys.argv) > 5 else 20.0
    simulation = sys.argv[6] if len(sys.argv) > 6 else ""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "rig.launch").write_text(LAUNCH.replace("FOLDER", name))
        if calibration == "none":
            calibration = recorded_calibration(folder, rows, columns)
        with running("roslaunch", "-p", new_master(), str(folder / "rig.launch"), f"rows:={rows}", f"columns:={columns}",
                     f"rate:={rate}", f"calibration:={calibration}", f"simulation:={simulation}"):
            import rosgraph
            import xmlrpc.client
            while not first_line("rostopic", "echo", "-n", "1", "/fsr/pressure_map/state"):
                time.sleep(0.2)
            master = rosgraph.Master("/cpu_share")
            pids = {node: xmlrpc.client.ServerProxy(master.lookupNode(f"/fsr/{node}")).getPid("/cpu_share")[2] for node in NODES}
            before, start = {node: cpu_seconds(pid) for node, pid in pids.items()}, time.monotonic()
            time.sleep(seconds)
            span = time.monotonic() - start
            shares = {node: (cpu_seconds(pid) - before[node]) / span for node, pid in pids.items()}
    print(f"{rows} x {columns}, {rate} Hz: " + ", ".join(f"{node} {100 * share:.1f} %" for node, share in shares.items()))


main()
