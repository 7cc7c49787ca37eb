// How much memory there is, and how much this process holds.
#pragma once

namespace agricolmap::batch {

/// Memory that could be had without any being swapped out: what the system says is available, or
/// what is left of the control group's limit, if that is less [bytes]; 0: nobody knows.
double availableMemory();

/// Memory that this process holds, files that it reads left out [bytes]; 0: nobody knows.
double memoryInUse();

}  // namespace agricolmap::batch
