// A thread that runs one job at a time. From post() until done() the thread owns the data that the job uses, so neither side locks it.
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
    ~Worker();  // waits for the running job
    Worker(const Worker&) = delete;

    // Requires done(). The job must not throw.
    void post(std::function<void()> job);
    // Waits at most `timeout`; true if no job is running.
    bool done(std::chrono::microseconds timeout = std::chrono::microseconds(0));
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
