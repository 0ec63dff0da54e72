#include "voxel/worker.h"

#include <cassert>

namespace obscura::voxel {

Worker::Worker() : m_thread([this] { loop(); }) {}

Worker::~Worker() {
    {
        const std::lock_guard lock(m_mutex);
        m_stop = true;
    }
    m_changed.notify_all();
    m_thread.join();
}

void Worker::loop() {
    std::unique_lock lock(m_mutex);
    for (;;) {
        m_changed.wait(lock, [this] { return m_busy || m_stop; });
        if (!m_busy) return;
        lock.unlock();
        m_job();
        lock.lock();
        m_busy = false;
        m_changed.notify_all();
    }
}

void Worker::post(std::function<void()> job) {
    {
        const std::lock_guard lock(m_mutex);
        assert(!m_busy);
        m_job = std::move(job);
        m_busy = true;
    }
    m_changed.notify_all();
}

bool Worker::done(std::chrono::microseconds timeout) {
    std::unique_lock lock(m_mutex);
    return m_changed.wait_for(lock, timeout, [this] { return !m_busy; });
}

void Worker::wait() {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [this] { return !m_busy; });
}

}  // namespace obscura::voxel
