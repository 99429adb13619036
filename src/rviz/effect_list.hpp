#pragma once

#include <QTreeWidget>
#include <string>
#include <vector>

#include "rviz/panel_state.hpp"

namespace tissue_stiffness {

/// List of the added effects and of those that may be missing, one row for each.
class EffectList : public QTreeWidget {
 public:
  explicit EffectList(QWidget* parent);

  /// Replaces the rows. The selected effect stays selected.
  void show_rows(const std::vector<EffectRow>& rows);
  /// Returns the effect of the selected row if it is an added one (or not, for `added` = false); empty otherwise.
  std::string selected(bool added) const;
};

}  // namespace tissue_stiffness
