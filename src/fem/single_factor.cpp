#include "fem/single_factor.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <queue>
#include <utility>

#include "fem/panel.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kSplit = 12;                  // subtrees that share the work, whatever the number of cores
constexpr Eigen::Index kWorthSharing = 200 * 1000;  // values

}  // namespace

SingleFactor::SingleFactor(Layout layout) : l_(std::move(layout)) {
  size_ = static_cast<int>(l_.permutation.size());
  plan();
}

// Cuts the elimination tree's heaviest subtrees until there are enough of them.
void SingleFactor::plan() {
  const int count = static_cast<int>(l_.first.size()) - 1;
  std::vector<int> owner(static_cast<std::size_t>(size_)), begin(static_cast<std::size_t>(count));
  std::vector<std::size_t> weight(static_cast<std::size_t>(count));
  std::vector<std::vector<int>> children(static_cast<std::size_t>(count));
  std::vector<int> roots;
  for (int s = 0; s < count; ++s) {
    const auto i = static_cast<std::size_t>(s);
    begin[i] = s;
    std::fill(owner.begin() + l_.first[i], owner.begin() + l_.first[i + 1], s);
    inside_.push_back(static_cast<int>(l_.row_start[i + 1] - l_.row_start[i]));
  }
  for (int s = 0; s < count; ++s) {
    const auto i = static_cast<std::size_t>(s);
    weight[i] += l_.value_start[i + 1] - l_.value_start[i];
    const std::size_t next = l_.row_start[i] + static_cast<std::size_t>(l_.first[i + 1] - l_.first[i]);
    if (next == l_.row_start[i + 1]) {
      roots.push_back(s);
      continue;
    }
    const int parent = owner[static_cast<std::size_t>(l_.rows[next])];
    weight[static_cast<std::size_t>(parent)] += weight[i];
    begin[static_cast<std::size_t>(parent)] = std::min(begin[static_cast<std::size_t>(parent)], begin[i]);
    children[static_cast<std::size_t>(parent)].push_back(s);
  }
  if (l_.values.size() < kWorthSharing) {
    for (int s = 0; s < count; ++s) top_.push_back(s);
    return;
  }
  std::priority_queue<std::pair<std::size_t, int>> subtrees;
  for (const int root : roots) subtrees.emplace(weight[static_cast<std::size_t>(root)], root);
  while (subtrees.size() < kSplit && !children[static_cast<std::size_t>(subtrees.top().second)].empty()) {
    const int cut = subtrees.top().second;
    subtrees.pop();
    top_.push_back(cut);
    for (const int child : children[static_cast<std::size_t>(cut)]) {
      subtrees.emplace(weight[static_cast<std::size_t>(child)], child);
    }
  }
  std::sort(top_.begin(), top_.end());
  for (; !subtrees.empty(); subtrees.pop()) {
    add_task(subtrees.top().second, begin[static_cast<std::size_t>(subtrees.top().second)]);
  }
}

// Rows beyond the subtree become indices into the task's list, which holds the rows of its root.
void SingleFactor::add_task(int root, int begin) {
  const auto r = static_cast<std::size_t>(root);
  const auto own = l_.row_start[r] + static_cast<std::size_t>(l_.first[r + 1] - l_.first[r]);
  Task task{begin,
            root + 1,
            {l_.rows.begin() + static_cast<long>(own), l_.rows.begin() + static_cast<long>(l_.row_start[r + 1])}};
  const int limit = l_.first[r + 1];
  for (auto s = static_cast<std::size_t>(begin); s <= r; ++s) {
    const auto from = l_.rows.begin() + static_cast<long>(l_.row_start[s]),
               to = l_.rows.begin() + static_cast<long>(l_.row_start[s + 1]);
    const auto split = std::lower_bound(from, to, limit);
    inside_[s] = static_cast<int>(split - from);
    for (auto row = split; row != to; ++row) {
      *row = static_cast<int>(std::lower_bound(task.beyond.begin(), task.beyond.end(), *row) - task.beyond.begin());
    }
  }
  tasks_.push_back(std::move(task));
}

// Substitution for up to kPanelColumns right-hand sides of n floats each.
struct SingleFactor::Sweep {
  const SingleFactor& f;
  int columns;
  Workspace& w;
  float* x = w.x.data();

  struct Supernode {
    int width, height, inside;
    const int* rows;
    const float* values;
    int first;
  };
  Supernode supernode(int index) const {
    const auto s = static_cast<std::size_t>(index);
    const Layout& l = f.l_;
    return {l.first[s + 1] - l.first[s],
            static_cast<int>(l.row_start[s + 1] - l.row_start[s]),
            f.inside_[s],
            l.rows.data() + l.row_start[s],
            l.values.data() + l.value_start[s],
            l.first[s]};
  }

  // Solves with the supernode's triangle and subtracts its contribution from the rows below. t: the supernode's rows,
  // `height` apart.
  void down(const Supernode& s, float* t) const {
    float c[kPanelWidth * kPanelColumns];
    for (int j = 0; j < s.width; j += kPanelWidth) {
      const int block = std::min(kPanelWidth, s.width - j);
      const float* panel = s.values + static_cast<long>(j) * s.height;
      for (int k = 0; k < columns; ++k) {
        float* tk = t + static_cast<long>(k) * s.height + j;
        for (int a = 0; a < block; ++a) {
          for (int b = 0; b < a; ++b) tk[a] -= panel[static_cast<long>(b) * s.height + j + a] * tk[b];
          tk[a] /= panel[static_cast<long>(a) * s.height + j + a];
          c[kPanelWidth * k + a] = tk[a];
        }
      }
      const int below = j + block, rest = s.height - below;
      if (block == kPanelWidth) {
        panel_subtract(rest, panel + below, s.height, c, columns, t + below, s.height);
        continue;
      }
      for (int k = 0; k < columns; ++k) {
        for (int b = 0; b < block; ++b) {
          const float* l = panel + static_cast<long>(b) * s.height + below;
          float* tk = t + static_cast<long>(k) * s.height + below;
          for (int i = 0; i < rest; ++i) tk[i] -= l[i] * c[kPanelWidth * k + b];
        }
      }
    }
  }

  // Solves with the transposed triangle.
  void up(const Supernode& s, float* t) const {
    float sums[kPanelWidth * kPanelColumns];
    const int ragged = s.width % kPanelWidth;
    for (int j = s.width; j > 0;) {
      const int block = j % kPanelWidth != 0 ? ragged : kPanelWidth;
      j -= block;
      const float* panel = s.values + static_cast<long>(j) * s.height;
      const int below = j + block, rest = s.height - below;
      if (block == kPanelWidth) {
        panel_dot(rest, panel + below, s.height, t + below, s.height, columns, sums);
      } else {
        for (int k = 0; k < columns; ++k) {
          for (int b = 0; b < block; ++b) {
            const float *l = panel + static_cast<long>(b) * s.height + below,
                        *tk = t + static_cast<long>(k) * s.height + below;
            float sum = 0.0F;
            for (int i = 0; i < rest; ++i) sum += l[i] * tk[i];
            sums[kPanelWidth * k + b] = sum;
          }
        }
      }
      for (int k = 0; k < columns; ++k) {
        float* tk = t + static_cast<long>(k) * s.height + j;
        for (int a = block; a-- > 0;) {
          const float* l = panel + static_cast<long>(a) * s.height + j;
          float value = tk[a] - sums[kPanelWidth * k + a];
          for (int b = a + 1; b < block; ++b) value -= l[b] * tk[b];
          tk[a] = value / l[a];
        }
      }
    }
  }

  // `beyond`: the subtree's contribution to the rows beyond it, `stride` apart; null for supernodes of no task.
  void forward(int index, std::vector<float>& local, float* beyond, long stride) const {
    const Supernode s = supernode(index);
    local.assign(static_cast<std::size_t>(s.height) * static_cast<std::size_t>(columns), 0.0F);
    for (int k = 0; k < columns; ++k) {
      std::copy_n(x + static_cast<long>(k) * f.size_ + s.first, s.width, local.data() + static_cast<long>(k) * s.height);
    }
    down(s, local.data());
    for (int k = 0; k < columns; ++k) {
      float* xk = x + static_cast<long>(k) * f.size_;
      const float* tk = local.data() + static_cast<long>(k) * s.height;
      std::copy_n(tk, s.width, xk + s.first);
      for (int i = s.width; i < s.inside; ++i) xk[s.rows[i]] += tk[i];
      for (int i = s.inside; i < s.height; ++i) beyond[k * stride + s.rows[i]] += tk[i];
    }
  }

  void backward(int index, std::vector<float>& local, const std::vector<int>* beyond) const {
    const Supernode s = supernode(index);
    local.resize(static_cast<std::size_t>(s.height) * static_cast<std::size_t>(columns));
    for (int k = 0; k < columns; ++k) {
      const float* xk = x + static_cast<long>(k) * f.size_;
      float* tk = local.data() + static_cast<long>(k) * s.height;
      std::copy_n(xk + s.first, s.width, tk);
      for (int i = s.width; i < s.inside; ++i) tk[i] = xk[s.rows[i]];
      for (int i = s.inside; i < s.height; ++i) tk[i] = xk[(*beyond)[static_cast<std::size_t>(s.rows[i])]];
    }
    up(s, local.data());
    for (int k = 0; k < columns; ++k) {
      std::copy_n(local.data() + static_cast<long>(k) * s.height, s.width, x + static_cast<long>(k) * f.size_ + s.first);
    }
  }

  void run() const {
    const auto& tasks = f.tasks_;
    w.beyond.resize(tasks.size());
    w.supernode.resize(tasks.size() + 1);
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
      const auto stride = static_cast<long>(tasks[i].beyond.size());
      w.beyond[i].assign(tasks[i].beyond.size() * static_cast<std::size_t>(columns), 0.0F);
      for (int s = tasks[i].begin; s < tasks[i].end; ++s) forward(s, w.supernode[i], w.beyond[i].data(), stride);
    });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const float* from = w.beyond[i].data();
      for (int k = 0; k < columns; ++k) {
        for (const int row : tasks[i].beyond) x[static_cast<long>(k) * f.size_ + row] += *from++;
      }
    }
    for (const int s : f.top_) forward(s, w.supernode.back(), nullptr, 0);
    for (std::size_t i = f.top_.size(); i-- > 0;) backward(f.top_[i], w.supernode.back(), nullptr);
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
      for (int s = tasks[i].end; s-- > tasks[i].begin;) backward(s, w.supernode[i], &tasks[i].beyond);
    });
  }
};

void SingleFactor::solve(Eigen::Ref<Eigen::MatrixXd> x, Workspace& workspace) const {
  Eigen::MatrixXf& rows = workspace.x;
  rows.resize(size_, kPanelColumns);
  for (Eigen::Index at = 0; at < x.cols(); at += kPanelColumns) {
    auto part = x.middleCols(at, std::min<Eigen::Index>(kPanelColumns, x.cols() - at));
    // Single precision reaches from 1e-38 to 1e38: scaled, no right-hand side leaves it.
    double scale[kPanelColumns];
    for (Eigen::Index k = 0; k < part.cols(); ++k) {
      const double largest = part.col(k).cwiseAbs().maxCoeff();
      scale[k] = largest > 0.0 ? largest : 1.0;
      for (int i = 0; i < size_; ++i) {
        rows(i, k) = static_cast<float>(part(l_.permutation[static_cast<std::size_t>(i)], k) / scale[k]);
      }
    }
    Sweep{*this, static_cast<int>(part.cols()), workspace}.run();
    for (Eigen::Index k = 0; k < part.cols(); ++k) {
      for (int i = 0; i < size_; ++i) {
        part(l_.permutation[static_cast<std::size_t>(i)], k) = scale[k] * static_cast<double>(rows(i, k));
      }
    }
  }
}

}  // namespace tissue_stiffness
