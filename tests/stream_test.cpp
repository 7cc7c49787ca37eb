// A fixed map that passes by and is not kept registers as one that is kept does, to the bit.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/cloud/tiled_stream.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap {
namespace {

class Stream : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
    options.field.width = options.field.height = 16.0;
    options.ugv.length = 6.0;
    options.seed = 21;
    pair_ = new simulate::SimulatedPair(simulate::simulatePair(options));
    folder_ = std::filesystem::temp_directory_path() /
              ("agricolmap-stream-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  static void TearDownTestSuite() {
    std::filesystem::remove_all(folder_);
    delete pair_;
    pair_ = nullptr;
  }

  static std::filesystem::path written(io::CloudFormat format) {
    const auto path = folder_ / ("uav." + io::endingOf(format));
    io::writeCloud(path, pair_->uav, format);
    return path;
  }
  static pipeline::Registration registered(const PointStream& fixed,
                                           const pipeline::RegistrationOptions& options) {
    Monitor monitor;
    return pipeline::registerClouds(fixed, pair_->ugv, pair_->prior, options, monitor);
  }

  static simulate::SimulatedPair* pair_;
  static std::filesystem::path folder_;
};
simulate::SimulatedPair* Stream::pair_ = nullptr;
std::filesystem::path Stream::folder_;

template <typename T>
bool sameRaster(const Raster<T>& one, const Raster<T>& other) {
  return one.rows() == other.rows() && std::equal(one.begin(), one.end(), other.begin());
}

void expectSame(const pipeline::Registration& streamed, const pipeline::Registration& kept) {
  EXPECT_EQ(streamed.verdict.status, kept.verdict.status);
  EXPECT_EQ(streamed.verdict.plane_probability, kept.verdict.plane_probability);
  ASSERT_TRUE(streamed.transform && kept.transform);
  EXPECT_TRUE(streamed.transform->fixed_from_moving.matrix() ==
              kept.transform->fixed_from_moving.matrix());
  EXPECT_EQ(streamed.maps.fixed.points, kept.maps.fixed.points);
  EXPECT_TRUE(sameRaster(streamed.maps.fixed.weight, kept.maps.fixed.weight));
  EXPECT_TRUE(sameRaster(streamed.maps.fixed.height, kept.maps.fixed.height));
  EXPECT_TRUE(sameRaster(streamed.maps.fixed.exg, kept.maps.fixed.exg));
  EXPECT_TRUE(sameRaster(streamed.maps.fixed.colour, kept.maps.fixed.colour));
}

TEST_F(Stream, RegistersAsWhatIsKeptInEveryFormatOnAnyNumberOfThreads) {
  ASSERT_GT(pair_->uav.size(), PointStream::kBatch);
  const pipeline::RegistrationOptions options = pipeline::preset("default");
  for (const io::CloudFormat format : {io::CloudFormat::kPly, io::CloudFormat::kPcd,
                                       io::CloudFormat::kLas, io::CloudFormat::kLaz}) {
#ifndef AGRICOLMAP_HAS_LASZIP
    if (format == io::CloudFormat::kLaz) continue;
#endif
    SCOPED_TRACE(io::endingOf(format));
    const auto path = written(format);
    const Cloud cloud = io::readCloud(path);
    const pipeline::Registration kept = registered(CloudStream(cloud), options);
    EXPECT_EQ(kept.verdict.status, verdict::Status::kAccepted);
    for (const int threads : {1, 2, 3}) {
      const ThreadLimit limit(threads);
      const auto stream = io::streamCloud(path, {.read = {}, .keep = 0, .on_pass = {}, .crs = {}});
      expectSame(registered(*stream, options), kept);
    }
  }
}

TEST_F(Stream, RegistersAsWhatIsKeptWithoutAGuess) {
  pipeline::RegistrationOptions options = pipeline::preset("default");
  options.prior = PriorUncertainty::none();
  const auto path = written(io::CloudFormat::kLas);
  const Cloud cloud = io::readCloud(path);
  const auto stream = io::streamCloud(path, {.read = {}, .keep = 0, .on_pass = {}, .crs = {}});
  expectSame(registered(*stream, options), registered(CloudStream(cloud), options));
}

// One map for several strips at once: each answer is that of a registration by itself.
TEST_F(Stream, SharedByStripsRegistersEachAsAlone) {
  const CloudStream alone(pair_->uav);
  std::vector<pipeline::RegistrationOptions> strips(3, pipeline::preset("default"));
  strips[1].prior = PriorUncertainty::none();
  strips[2].pieces.from = 5.0;  // a frame that is turned along the strip
  const io::TiledStream tiled(alone);
  const pipeline::FixedCloud shared(tiled);
  std::vector<pipeline::Registration> found(strips.size());
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < strips.size(); ++i) {
      threads.emplace_back([&, i] {
        Monitor monitor;
        found[i] = pipeline::registerClouds(shared, pair_->ugv, pair_->prior, strips[i], monitor);
      });
    }
  }
  for (std::size_t i = 0; i < strips.size(); ++i) {
    SCOPED_TRACE(i);
    expectSame(found[i], registered(alone, strips[i]));
  }
}

/// Ends in an error on the way, as a file on a disk that fails.
class Failing : public PointStream {
 public:
  Failing(const Cloud& cloud, int passes) : stream_(cloud), left_(passes) {}
  const CloudFacts& facts() const override { return stream_.facts(); }
  Box3 box() const override { return stream_.box(); }
  void pass(const Visit& visit) const override {
    bool first = true;
    stream_.pass([&](const PointBatch& batch) {
      if (left_ == 0 && !first) throw InputError("the disk failed");
      first = false;
      visit(batch);
    });
    --left_;
  }
  int left() const { return left_; }

 private:
  CloudStream stream_;
  mutable int left_;
};

TEST_F(Stream, ThatFailsMidwayIsAnError) {
  const pipeline::RegistrationOptions options = pipeline::preset("default");
  const Failing whole(pair_->uav, 100);
  registered(whole, options);
  const int passes = 100 - whole.left();
  EXPECT_GE(passes, 4);
  for (int good = 0; good < passes; ++good) {
    const Failing failing(pair_->uav, good);
    EXPECT_THROW(registered(failing, options), InputError) << good;
  }
}

}  // namespace
}  // namespace agricolmap
