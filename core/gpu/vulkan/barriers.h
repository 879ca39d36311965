// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which barriers a sequence of uses needs. One command list tracks what it touches, starting from what
// earlier submissions left; the result becomes the resource's state when the list is submitted.

#include <map>
#include <vector>

#include "core/gpu/vulkan/resources.h"

namespace hairloom::gpu::vulkan {

struct Use {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< of textures
    bool write = false;
    bool discard = false;  ///< the old content of a texture is not needed
};

class BarrierTracker {
  public:
    void use(BufferImpl& buffer, const Use& use);
    void use(TextureImpl& texture, const Use& use);
    /// Records what has gathered, if anything, as one barrier.
    void flush(VkCommandBuffer commands);
    /// The states become those that the next list starts from.
    void commit();

  private:
    struct Transition {
        bool needed = false;
        VkPipelineStageFlags2 sourceStages = 0;
        VkAccessFlags2 sourceAccess = 0;
        VkPipelineStageFlags2 targetStages = 0;
        VkAccessFlags2 targetAccess = 0;
        VkImageLayout oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    };
    template <class Barrier>
    static Barrier barrierFor(VkStructureType type, const Transition& t);
    static Transition advance(AccessState& state, const Use& use, bool isTexture);

    std::map<BufferImpl*, AccessState> buffers_;
    std::map<TextureImpl*, AccessState> textures_;
    std::vector<VkBufferMemoryBarrier2> bufferBarriers_;
    std::vector<VkImageMemoryBarrier2> imageBarriers_;
};

}  // namespace hairloom::gpu::vulkan
