#include "agricolmap/report/counts.hpp"

#include <algorithm>

namespace agricolmap::report {
namespace {

using Counts = std::vector<std::pair<std::string, double>>;

void add(Counts& counts, const char* name, std::size_t count) {
  counts.emplace_back(name, static_cast<double>(count));
}

void addSearch(Counts& counts, const locate::SearchReport& search, std::size_t placements) {
  add(counts, "hypotheses", search.hypotheses);
  add(counts, "correlations", search.correlations);
  counts.emplace_back("rows_on_rows", search.rows_on_rows ? 1.0 : 0.0);
  counts.emplace_back("search_cell_m", search.cell);
  add(counts, "blocks", search.blocks);
  add(counts, "placements", placements);
}

void addFlow(Counts& counts, const paper::FlowReport& flow) {
  add(counts, "seeds", flow.seeds);
  add(counts, "matches", flow.first.matches);
  add(counts, "inliers", flow.first.inliers);
  counts.emplace_back("inlier_share", flow.first.share());
  if (!flow.again) return;
  add(counts, "rematches", flow.again->matches);
  add(counts, "rematch_inliers", flow.again->inliers);
  counts.emplace_back("rematch_share", flow.again->share());
}

void addCpd(Counts& counts, const pipeline::CpdReport& cpd) {
  add(counts, "fixed_vegetation_points", cpd.fixed_points);
  add(counts, "moving_vegetation_points", cpd.moving_points);
  add(counts, "cpd_iterations", cpd.iterations);
  counts.emplace_back("cpd_matched_share", cpd.matched_share);
}

}  // namespace

Counts countsOf(const pipeline::Registration& registration) {
  const pipeline::Trace& trace = registration.trace;
  Counts counts;
  add(counts, "fixed_cells", registration.maps.fixed.filled);
  add(counts, "moving_cells", registration.maps.moving.filled);
  add(counts, "attempts", trace.attempts);
  if (trace.located.search) {
    addSearch(counts, *trace.located.search, trace.located.placements.size());
  }
  if (trace.located.flow) addFlow(counts, *trace.located.flow);
  if (trace.cpd) {
    addCpd(counts, *trace.cpd);
  } else {
    add(counts, "refined_placements", trace.held);
  }
  if (!trace.pieces.empty()) {
    add(counts, "pieces", trace.pieces.size());
    add(counts, "found_pieces",
        static_cast<std::size_t>(std::count_if(trace.pieces.begin(), trace.pieces.end(),
                                               [](const auto& piece) { return piece.held; })));
  }
  if (trace.straightened) counts.emplace_back("straightened", *trace.straightened ? 1.0 : 0.0);
  return counts;
}

const Placement& winnerOf(const pipeline::Registration& registration) {
  return registration.trace.located.placements.at(registration.placed->placement);
}

}  // namespace agricolmap::report
