import os
import subprocess
import sys
import textwrap


def test_no_descendant_survives_the_end_even_if_it_ignores_requests_and_lost_its_parent():
    script = """
        import subprocess, time
        from supervision.processes import adopt_orphans, end_descendants
        import psutil
        adopt_orphans()
        stubborn = "trap '' TERM INT; while true; do sleep 0.1; done"
        subprocess.Popen(["bash", "-c", f"(setsid bash -c \\"{stubborn}\\" &) ; exit 0"]).wait()
        time.sleep(0.3)
        assert psutil.Process().children(recursive=True), "the orphan should have been adopted"
        end_descendants(0.5)
        left = [p for p in psutil.Process().children(recursive=True) if p.status() != "zombie"]
        assert not left, left
    """
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, "-c", textwrap.dedent(script)], env=environment, check=True, timeout=20)
