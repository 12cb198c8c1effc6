"""Threads of a node of roscpp that wake up at one instant run one after another."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

LIBRARY = Path(__file__).resolve().parents[1] / "preload" / "ordered_wake.cpp"
# What of roscpp matters: all sleepers look at the time once a millisecond, each for itself.
HEADER = """
namespace ros
{
struct Time
{
  unsigned sec, nsec;
  static Time now();
  static void setNow(const Time&);
  static bool useSystemTime();
};
struct Duration { int sec, nsec; bool sleep() const; };
}
"""
TIME = """
#include "ros_time.h"
#include <atomic>
#include <chrono>
#include <random>
#include <thread>
namespace ros
{
std::atomic<unsigned> g_now{0};
Time Time::now() { return {g_now, 0}; }
void Time::setNow(const Time& now) { g_now = now.sec; }
bool Time::useSystemTime() { return false; }
bool Duration::sleep() const
{
  thread_local std::mt19937 chance{std::random_device{}()};
  const unsigned end = g_now + sec;
  std::this_thread::sleep_for(std::chrono::microseconds(chance() % 1000));
  while (g_now < end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return true;
}
}
"""
NODE = """
#include "ros_time.h"
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>
#include <vector>
std::atomic<int> running{0};
std::mutex order_mutex;
std::vector<int> order;
void compute(int number)
{
  if (++running > 1) std::puts("two at once");
  { std::lock_guard<std::mutex> lock(order_mutex); order.push_back(number); }
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
  while (std::chrono::steady_clock::now() < end) {}
  --running;
}
void sleep_together()
{
  std::vector<std::thread> threads;
  for (int number = 0; number < 4; ++number)
    threads.emplace_back([number] { ros::Duration{5, 0}.sleep(); compute(number); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ros::Time::setNow({10, 0});
  for (auto& thread : threads) thread.join();
}
void sleep_alone()
{
  std::atomic<long> number{0};
  std::thread sleeping([&] {
    number = syscall(SYS_gettid);
    ros::Duration{5, 0}.sleep();
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::ifstream file("/proc/self/task/" + std::to_string(number) + "/stat");
  ros::Time::setNow({10, 0});
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::printf(text[text.rfind(')') + 2] == 'R' ? "ready" : "at rest");
  sleeping.join();
}
void wake_another()
{
  std::mutex mutex;
  std::condition_variable condition;
  bool is_awake = false;
  std::thread waiting([&] {
    std::unique_lock<std::mutex> lock(mutex);
    while (!is_awake) condition.wait(lock);
    lock.unlock();
    compute(1);
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  { std::lock_guard<std::mutex> lock(mutex); is_awake = true; condition.notify_one(); }
  compute(0);
  waiting.join();
}
int main(int, char** words)
{
  ros::Time::setNow({1, 0});
  const std::map<std::string, void (*)()> cases{
      {"together", sleep_together}, {"alone", sleep_alone}, {"wake", wake_another}};
  cases.at(words[1])();
  for (int number : order) std::printf("%d", number);
}
"""


@pytest.fixture(scope="module")
def node(tmp_path_factory):
    folder = tmp_path_factory.mktemp("node")
    compiler = shutil.which("c++")
    assert compiler is not None, "a compiler, which catkin needs, too"
    (folder / "ros_time.h").write_text(HEADER)
    (folder / "time.cpp").write_text(TIME)
    (folder / "node.cpp").write_text(NODE)
    shared = [compiler, "-std=c++11", "-O1", "-pthread", "-shared", "-fPIC"]
    subprocess.run([*shared, "-o", "libtime.so", "time.cpp"], cwd=folder, check=True)
    strict = ["-Wall", "-Wextra", "-Werror"]
    subprocess.run([*shared, *strict, "-o", "libordered.so", str(LIBRARY), "-ldl"], cwd=folder, check=True)
    options = ["-std=c++11", "-O1", "-pthread", "-o", "node", "node.cpp", "-L.", "-ltime", "-Wl,-rpath,."]
    subprocess.run([compiler, *options], cwd=folder, check=True)
    return folder


def outputs(folder, what, runs, **environment):
    environment = {**os.environ, **environment}
    return [
        subprocess.run(["./node", what], cwd=folder, env=environment, capture_output=True, text=True).stdout
        for _ in range(runs)
    ]


def test_threads_take_turns_in_the_order_of_their_creation(node):
    assert outputs(node, "together", 10, LD_PRELOAD=str(node / "libordered.so")) == ["0123"] * 10


def test_their_order_is_that_of_their_creation_also_where_the_kernel_counts_threads_from_the_start(node):
    unshare = ["unshare", "--pid", "--fork", "--mount-proc", *([] if os.geteuid() == 0 else ["-r"])]
    count = "expr $(cat /proc/sys/kernel/pid_max) - 3 > /proc/sys/kernel/ns_last_pid"
    if subprocess.run([*unshare, "sh", "-c", count], capture_output=True).returncode:
        pytest.skip("this system allows no numbers of processes of a test's own")
    run = [*unshare, "sh", "-c", f"{count} && LD_PRELOAD=./libordered.so exec ./node together"]
    assert subprocess.run(run, cwd=node, capture_output=True, text=True).stdout == "0123"


def test_the_clock_wakes_a_thread_at_once(node):
    assert outputs(node, "alone", 10, LD_PRELOAD=str(node / "libordered.so")) == ["ready"] * 10


def test_a_thread_that_another_one_wakes_waits_until_that_one_rests(node):
    assert outputs(node, "wake", 10, LD_PRELOAD=str(node / "libordered.so")) == ["01"] * 10


def test_without_the_library_their_order_is_chance(node):
    assert len(set(outputs(node, "together", 10))) > 1
