import time, pytest
pytest.importorskip("rclpy")
from diagnostic_msgs.msg import DiagnosticArray
from test_monitor_node import setpoints, statuses, value
pytestmark = pytest.mark.ros
def test_300(graph):
    (graph.folder / "setpoints.csv").write_text(setpoints(900))
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("plant", "hall_voltage_noise:=0.003")
    graph.start("controller", "setpoint_file:=setpoints.csv")
    graph.start("monitor")
    graph.until(lambda: statuses(graph), "the monitor")
    t0=time.time()
    while time.time()-t0 < 320:
        n=value(graph,"movements")
        try: graph.until(lambda: value(graph,"movements")>n, "more")
        except Exception as e: print("no more", e)
    seen={}
    for s in statuses(graph):
        seen.setdefault((s.level,s.message[:90]),0); seen[(s.level,s.message[:90])]+=1
    print(seen, value(graph,"movements"), value(graph,"samples"))
