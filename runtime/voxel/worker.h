// A thread that does one job at a time while its owner goes on. What a job reads and writes belongs to the thread from post()
// until done(): two sides take turns, and neither needs a lock around its data.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace obscura::voxel {

class Worker {
public:
    Worker();
    ~Worker();  // waits for the job that is running
    Worker(const Worker&) = delete;

    // Only while done(). The job must not throw.
    void post(std::function<void()> job);
    // Whether no job is left; waits for that at most so long.
    bool done(std::chrono::microseconds most = std::chrono::microseconds(0));
    void wait();

private:
    void loop();
    std::mutex m_mutex;
    std::condition_variable m_changed;
    std::function<void()> m_job;
    bool m_busy = false, m_stop = false;
    std::thread m_thread;
};

}  // namespace obscura::voxel
