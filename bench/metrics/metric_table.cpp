#include "bench/metrics/metrics.h"

namespace pb {
namespace {

// Value readers of the table below; nullopt where the metric is not defined for the pair or the region.
template <double ErrorSums::*member>
std::optional<double> sum(const Metrics& metrics) {
  return metrics.sums.*member;
}

std::optional<double> ssimMean(const Metrics& metrics) {
  return metrics.ssim ? std::optional(metrics.ssim->mean) : std::nullopt;
}

std::optional<double> ssimLuma(const Metrics& metrics) {
  return metrics.ssim ? std::optional(metrics.ssim->luma) : std::nullopt;
}

std::optional<double> msSsim(const Metrics& metrics) { return metrics.msSsim; }

std::optional<double> flipLdr(const Metrics& metrics) { return metrics.flipLdr.mean; }

std::optional<double> flipHdr(const Metrics& metrics) {
  return metrics.flipHdr ? std::optional(metrics.flipHdr->mean) : std::nullopt;
}

}  // namespace

const std::vector<MetricInfo>& metricTable() {
  static const std::vector<MetricInfo> table = {
      {"bias", true, "mean(t - r), signed: 0 is best", sum<&ErrorSums::bias>},
      {"mse", true, "mean((t - r)^2)", sum<&ErrorSums::mse>},
      {"rmse", true, "sqrt(mse)", sum<&ErrorSums::rmse>},
      {"mae", true, "mean(|t - r|)", sum<&ErrorSums::mae>},
      {"max_abs", true, "max(|t - r|)", sum<&ErrorSums::maxAbs>},
      {"psnr", false, "10 log10(1 / mse), dB for peak 1", sum<&ErrorSums::psnr>},
      {"relmse", true, "mean((t - r)^2 / (r^2 + 0.01))", sum<&ErrorSums::relmse>},
      {"smape", true, "mean(|t - r| / (|r| + |t| + 0.01))", sum<&ErrorSums::smape>},
      {"ssim", false, "structural similarity, mean of the channels (Wang et al. 2004)", ssimMean},
      {"ssim_luma", false, "structural similarity of luma (Wang et al. 2004)", ssimLuma},
      {"ms_ssim", false, "structural similarity at five scales (Wang et al. 2003)", msSsim},
      {"flip_ldr", true, "LDR-FLIP, mean of the map (Andersson et al. 2020)", flipLdr},
      {"flip_hdr", true, "HDR-FLIP, mean of the map (Andersson et al. 2021)", flipHdr},
  };
  return table;
}

}  // namespace pb
