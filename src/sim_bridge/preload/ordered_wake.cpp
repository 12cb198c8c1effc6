// Preloaded into a node of roscpp: its threads that wake up at one instant of simulated time run one after another.
//
// Threads that are due at the same instant, such as the control loop and the map updates of move_base, look at the
// clock once a millisecond, each for itself, so that their order is chance, and on a busy machine a look comes
// late. With this library a change of the clock wakes all of them, so that the simulator sees at once that the node
// does not rest. A thread whose sleep is over waits until those have had their turn that are due as well and were
// created before it, and until all others rest. So does a thread that another one has woken, such as the planner of
// move_base by a new goal. Meanwhile it is ready to run.
//
// Use: env LD_PRELOAD=libordered_wake.so NODE

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace ros
{
// As in roscpp_core.
struct Time
{
  uint32_t sec;
  uint32_t nsec;
  static Time now();
  static void setNow(const Time& now);
  static bool useSystemTime();
};

struct Duration
{
  int32_t sec;
  int32_t nsec;
  bool sleep() const;
};
}  // namespace ros

namespace
{
using Clock = std::chrono::steady_clock;

// Longest wait between two looks at the clock [ns].
constexpr int64_t LOOK = 1000000;
// Time for which the others must rest: what a thread has woken is ready to run at once.
constexpr std::chrono::microseconds QUIET{300};
// Looks in succession at which all of them must rest.
constexpr int LOOKS = 3;
// Time after which a thread goes on in any case: others may never rest.
constexpr std::chrono::seconds PATIENCE{2};

std::mutex g_mutex;
// A thread that sleeps or waits for its turn: its number in the kernel, and the simulated time until then [ns].
struct Sleeper
{
  int thread;
  int64_t due;
};

// By the order in which the threads were created: the kernel's numbers begin again at the highest.
std::map<int, Sleeper> g_sleeping;
std::atomic<int> g_created{0};
thread_local int t_place = 0;
// Number of changes of the clock, for which threads wait.
std::atomic<uint32_t> g_changes{0};

// The next definition of a function that is replaced here.
template <typename Function>
Function original(const char* name)
{
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

int64_t nanoseconds(int64_t sec, int64_t nsec)
{
  return sec * 1000000000 + nsec;
}

bool is_shutting_down()
{
  static const auto is_shutting_down = reinterpret_cast<bool (*)()>(dlsym(RTLD_DEFAULT, "_ZN3ros14isShuttingDownEv"));
  return is_shutting_down != nullptr && is_shutting_down();
}

// Whether the clock is that of a simulation; a node that shuts down may no longer rest.
bool is_time_simulated()
{
  return g_changes != 0 && !ros::Time::useSystemTime() && !is_shutting_down();
}

int64_t simulated_time()
{
  const ros::Time now = ros::Time::now();
  return nanoseconds(now.sec, now.nsec);
}

// Whether a thread waits for something, by the state in /proc/self/task/TID/stat, after the name in brackets.
bool is_resting(int thread)
{
  char path[64];
  char text[128];
  std::snprintf(path, sizeof(path), "/proc/self/task/%d/stat", thread);
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0)
  {
    return true;  // it has ended
  }
  const ssize_t count = read(file, text, sizeof(text) - 1);
  close(file);
  text[count > 0 ? count : 0] = '\0';
  const char* bracket = std::strrchr(text, ')');
  return bracket == nullptr || std::strchr("SItTXZ", bracket[2]) != nullptr;
}

bool is_sleeping(int thread)
{
  return std::any_of(g_sleeping.begin(), g_sleeping.end(),
                     [thread](const std::pair<const int, Sleeper>& each) { return each.second.thread == thread; });
}

// Number of a thread that neither sleeps in simulated time nor rests; 0 if there is none.
int find_busy()
{
  DIR* folder = opendir("/proc/self/task");
  int busy = 0;
  while (dirent* entry = folder != nullptr && busy == 0 ? readdir(folder) : nullptr)
  {
    const int thread = std::atoi(entry->d_name);
    busy = thread == 0 || is_sleeping(thread) || is_resting(thread) ? 0 : thread;
  }
  if (folder != nullptr)
  {
    closedir(folder);
  }
  return busy;
}

// Whether no thread is due that was created before this one.
bool is_first_due()
{
  const int64_t now = simulated_time();
  for (const auto& sleeper : g_sleeping)
  {
    if (sleeper.first == t_place || sleeper.second.due <= now)
    {
      return sleeper.first == t_place;
    }
  }
  return true;
}

// Note that this thread is due at a simulated time [ns].
void set_due(int64_t stamp)
{
  const int self = static_cast<int>(syscall(SYS_gettid));
  std::lock_guard<std::mutex> lock(g_mutex);
  g_sleeping[t_place] = Sleeper{self, stamp};
}

void wait_for_turn()
{
  std::unique_lock<std::mutex> lock(g_mutex);
  const Clock::time_point begin = Clock::now();
  Clock::time_point quiet_since = begin;
  int busy_before = 0;
  int rests = 0;
  for (;;)
  {
    const Clock::time_point now = Clock::now();
    const bool is_first = is_first_due();
    const int busy = is_first ? find_busy() : 0;
    // A thread that is seen running once has looked at the clock only.
    if (!is_first || (busy != 0 && busy == busy_before))
    {
      quiet_since = Clock::now();  // this thread may not have run for a while since the loop began
    }
    busy_before = busy;
    rests = is_first && busy == 0 ? rests + 1 : 0;
    if ((now - quiet_since >= QUIET && rests >= LOOKS) || now - begin >= PATIENCE || is_shutting_down())
    {
      break;
    }
    lock.unlock();
    sched_yield();
    lock.lock();
  }
  g_sleeping.erase(t_place);
}

// Wait for a change of the clock since the last call in this thread, as long as between two looks at most.
void wait_for_change()
{
  thread_local uint32_t seen = 0;
  const timespec limit{0, LOOK};
  syscall(SYS_futex, &g_changes, FUTEX_WAIT_PRIVATE, seen, &limit, nullptr, 0);
  seen = g_changes;
}

// Whether an instant of a clock is so near that a thread which waits for it looks at the simulated time in between.
bool is_near(clockid_t clock, const timespec& instant)
{
  timespec now;
  clock_gettime(clock, &now);
  const int64_t left = nanoseconds(instant.tv_sec - now.tv_sec, instant.tv_nsec - now.tv_nsec);
  return left > 0 && left <= LOOK;
}
// What a new thread does first.
struct Beginning
{
  void* (*function)(void*);
  void* argument;
  int place;
};

void* begin(void* data)
{
  const std::unique_ptr<Beginning> beginning(static_cast<Beginning*>(data));
  t_place = beginning->place;
  return beginning->function(beginning->argument);
}
}  // namespace

void ros::Time::setNow(const Time& now)
{
  static const auto set_now = original<void (*)(const Time&)>("_ZN3ros4Time6setNowERKS0_");
  set_now(now);
  ++g_changes;
  syscall(SYS_futex, &g_changes, FUTEX_WAKE_PRIVATE, INT32_MAX, nullptr, nullptr, 0);
}

bool ros::Duration::sleep() const
{
  static const auto sleep_for = original<bool (*)(const Duration*)>("_ZNK3ros8Duration5sleepEv");
  if (!is_time_simulated())
  {
    return sleep_for(this);
  }
  set_due(simulated_time() + nanoseconds(sec, nsec));
  const bool result = sleep_for(this);
  wait_for_turn();
  return result;
}

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*function)(void*),
                              void* argument) noexcept
{
  static const auto create = original<decltype(&pthread_create)>("pthread_create");
  std::unique_ptr<Beginning> beginning(new Beginning{function, argument, ++g_created});
  const int error = create(thread, attributes, begin, beginning.get());
  if (error == 0)
  {
    beginning.release();
  }
  return error;
}

extern "C" int nanosleep(const timespec* request, timespec* remaining)
{
  static const auto sleep_for = original<int (*)(const timespec*, timespec*)>("nanosleep");
  if (request->tv_sec != 0 || request->tv_nsec != LOOK || !is_time_simulated())
  {
    return sleep_for(request, remaining);
  }
  wait_for_change();
  return 0;
}

// Timers of roscpp look at the clock in between by this. What is notified meanwhile is found by the next look.
extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* instant)
{
  using Wait = int (*)(pthread_cond_t*, pthread_mutex_t*, const timespec*);
  static const auto wait = original<Wait>("pthread_cond_timedwait");
  if (!is_time_simulated() || !(is_near(CLOCK_MONOTONIC, *instant) || is_near(CLOCK_REALTIME, *instant)))
  {
    return wait(condition, mutex, instant);
  }
  pthread_mutex_unlock(mutex);
  wait_for_change();
  pthread_mutex_lock(mutex);
  return ETIMEDOUT;
}

extern "C" int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex)
{
  static const auto wait = original<int (*)(pthread_cond_t*, pthread_mutex_t*)>("pthread_cond_wait");
  const int result = wait(condition, mutex);
  if (is_time_simulated())
  {
    pthread_mutex_unlock(mutex);
    set_due(simulated_time());
    wait_for_turn();
    pthread_mutex_lock(mutex);
  }
  return result;
}
