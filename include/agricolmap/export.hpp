// Marks what the shared libraries show; everything else in them is hidden.
#pragma once

#define AGRICOLMAP_EXPORT __attribute__((visibility("default")))
