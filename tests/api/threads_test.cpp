// Contexts on several threads: each on its own device, and two on one device. The host locks the shared queue; the library needs no lock.
// Build with -fsanitize=thread to check for races.
#include <mutex>
#include <thread>

#include "api/host.h"

namespace obscura::ao {
namespace {

// Frame loop of one thread. Only the device may be shared: all other objects are its own.
struct Loop {
    gpu::Device& device;
    std::mutex& queue;
    Frame frame;
    std::vector<Status> failed;
    uint64_t bytes = 0;

    void operator()(uint32_t seed) {
        const gpu::Api& vk = device.vk();
        DeviceDesc desc;
        desc.instance = device.instance();
        desc.physicalDevice = device.physical();
        desc.device = device.handle();
        desc.queueFamily = device.queueFamily();
        desc.getInstanceProcAddr = vk.GetInstanceProcAddr;
        Context* context = nullptr;
        if (const Status status = create(desc, &context); status != Status::ok) return failed.push_back(status);
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        const VkCommandPoolCreateInfo poolInfo{
            VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, VK_COMMAND_POOL_CREATE_TRANSIENT_BIT, device.queueFamily()};
        vk.CreateCommandPool(device.handle(), &poolInfo, nullptr, &pool);
        const VkCommandBufferAllocateInfo one{
            VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
        vk.AllocateCommandBuffers(device.handle(), &one, &cmd);
        for (uint32_t i = 0; i < 2 * methods().size(); ++i) {
            const MethodInfo& info = *methods()[(i + seed) % methods().size()];
            if (const Status status = setMethod(context, info.id, {}); status != Status::ok) failed.push_back(status);
            for (int repeat = 0; repeat < 2; ++repeat) {
                const VkCommandBufferBeginInfo begin{
                    VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
                vk.ResetCommandPool(device.handle(), pool, 0);
                vk.BeginCommandBuffer(cmd, &begin);
                const Output output = record(context, cmd, frame);
                vk.EndCommandBuffer(cmd);
                if (output.status != Status::ok) failed.push_back(output.status);
                const VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, cmd, 0};
                VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
                submit.commandBufferInfoCount = 1;
                submit.pCommandBufferInfos = &buffer;
                std::lock_guard lock(queue);
                vk.QueueSubmit2(device.queue(), 1, &submit, VK_NULL_HANDLE);
                vk.QueueWaitIdle(device.queue());
            }
            timings(context);
            bytes = memoryUse(context);
        }
        destroy(context);
        vk.DestroyCommandPool(device.handle(), pool, nullptr);
    }
};

class Threads : public test::GpuTest {
protected:
    static Frame frameOf(test::Host& host) {
        test::Geometry g;
        g.visible = {32, 20};
        g.guard = {0, 0};
        return host.frame({g}, test::trace(g));
    }
    static void run(Loop& a, Loop& b) {
        std::thread first([&] { a(0); }), second([&] { b(5); });
        first.join();
        second.join();
        EXPECT_TRUE(a.failed.empty());
        EXPECT_TRUE(b.failed.empty());
        EXPECT_GT(a.bytes, 0u);
        EXPECT_EQ(a.bytes > 0, b.bytes > 0);
    }
};

TEST_F(Threads, contextsOnTwoDevices) {
    std::unique_ptr<gpu::Device> other = test::makeDevice();
    test::Host one(test::device()), two(*other);
    std::mutex queues[2];
    Loop a{test::device(), queues[0], frameOf(one)}, b{*other, queues[1], frameOf(two)};
    run(a, b);
    EXPECT_EQ(other->validationMessages(), 0u) << test::allLogged();
    two.clear();
}

TEST_F(Threads, contextsOnOneDevice) {
    test::Host host(test::device());
    std::mutex queue;
    Loop a{test::device(), queue, frameOf(host)}, b{test::device(), queue, a.frame};
    run(a, b);
}

}  // namespace
}  // namespace obscura::ao
