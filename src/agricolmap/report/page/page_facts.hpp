// What the page says beside registration.json, made where the numbers are.
#pragma once

#include <nlohmann/json.hpp>

#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/report/page/registration_page.hpp"

namespace agricolmap::report {

/// Every option with its value in force, its default, unit and meaning, in their order.
nlohmann::ordered_json optionsFacts(const pipeline::RegistrationOptions& in_force,
                                    const std::string& preset);

/// The blocks of the evidence: where they lie in the fixed cloud's local coordinates and along and
/// across the strip, and how far from there each fits best by itself, along and across.
nlohmann::ordered_json blocksFacts(const pipeline::Registration& registration);

/// The strip's extent along and across [m] and its direction in the fixed file's axes; null where
/// it was not placed.
nlohmann::ordered_json stripFacts(const pipeline::Registration& registration);

/// The rotation and shift that come nearest to the transform about the strip's middle, and how far
/// the strip's corners lie from where they should under it [m]; null without a transform.
nlohmann::ordered_json rigidFacts(const CloudOrigins& origins,
                                  const pipeline::Registration& registration);

}  // namespace agricolmap::report
