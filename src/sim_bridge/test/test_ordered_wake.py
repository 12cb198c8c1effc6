"""Threads of a node of roscpp that wake up at one instant run one after another."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

LIBRARY = Path(__file__).resolve().parents[1] / "preload" / "ordered_wake.cpp"
# What of roscpp matters: all sleepers look at the time once a millisecond, each for itself.
TIME = """
#include <atomic>
#include <chrono>
#include <random>
#include <thread>
std::atomic<bool> is_due{false};
namespace ros
{
struct Time { unsigned sec, nsec; static Time now(); static bool useSystemTime(); };
struct Duration { int sec, nsec; bool sleep() const; };
Time Time::now() { return {is_due ? 10u : 0u, 0}; }
bool Time::useSystemTime() { return false; }
bool Duration::sleep() const
{
  thread_local std::mt19937 chance{std::random_device{}()};
  std::this_thread::sleep_for(std::chrono::microseconds(chance() % 1000));
  while (!is_due) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return true;
}
}
"""
NODE = """
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>
extern std::atomic<bool> is_due;
namespace ros { struct Duration { int sec, nsec; bool sleep() const; }; }
int main()
{
  std::atomic<int> running{0};
  std::vector<int> order;
  std::vector<std::thread> threads;
  for (int number = 0; number < 4; ++number)
    threads.emplace_back([number, &running, &order] {
      ros::Duration{5, 0}.sleep();
      if (++running > 1) std::puts("two at once");
      order.push_back(number);
      const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
      while (std::chrono::steady_clock::now() < end) {}
      --running;
    });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  is_due = true;
  for (auto& thread : threads) thread.join();
  for (int number : order) std::printf("%d", number);
}
"""


@pytest.fixture(scope="module")
def node(tmp_path_factory):
    folder = tmp_path_factory.mktemp("node")
    compiler = shutil.which("c++")
    assert compiler is not None, "a compiler, which catkin needs, too"
    (folder / "time.cpp").write_text(TIME)
    (folder / "node.cpp").write_text(NODE)
    shared = [compiler, "-std=c++11", "-O1", "-pthread", "-shared", "-fPIC"]
    subprocess.run([*shared, "-o", "libtime.so", "time.cpp"], cwd=folder, check=True)
    strict = ["-Wall", "-Wextra", "-Werror"]
    subprocess.run([*shared, *strict, "-o", "libordered.so", str(LIBRARY), "-ldl"], cwd=folder, check=True)
    options = ["-std=c++11", "-O1", "-pthread", "-o", "node", "node.cpp", "-L.", "-ltime", "-Wl,-rpath,."]
    subprocess.run([compiler, *options], cwd=folder, check=True)
    return folder


def orders(folder, runs, **environment):
    environment = {**os.environ, **environment}
    return [
        subprocess.run(["./node"], cwd=folder, env=environment, capture_output=True, text=True).stdout
        for _ in range(runs)
    ]


def test_threads_take_turns_in_the_order_of_their_creation(node):
    assert orders(node, 10, LD_PRELOAD=str(node / "libordered.so")) == ["0123"] * 10


def test_without_the_library_their_order_is_chance(node):
    assert len(set(orders(node, 10))) > 1
