#include "rviz/effect_list.hpp"

#include <QHeaderView>

namespace tissue_stiffness {
namespace {

constexpr int kEffectRole = Qt::UserRole, kAddedRole = Qt::UserRole + 1;

QString text(const std::string& from) {
  return QString::fromStdString(from);
}

QTreeWidgetItem* item(const EffectRow& row) {
  auto* out = new QTreeWidgetItem;
  out->setText(0, (row.added ? QString("✓ ") : QString()) + text(row.title));
  out->setText(1, row.added ? QString("in the model") : text(row.probability));
  if (!row.added && !row.effect.empty()) out->setText(2, QString::number(100.0 * row.explained, 'f', 0) + " %");
  out->setText(3, text(row.error));
  out->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
  out->setTextAlignment(2, Qt::AlignRight | Qt::AlignVCenter);
  out->setData(0, kEffectRole, text(row.effect));
  out->setData(0, kAddedRole, row.added);
  for (int column = 0; column < 4; ++column) out->setToolTip(column, text(row.details));
  if (row.suspect || row.added) {
    QFont bold = out->font(0);
    bold.setBold(true);
    out->setFont(0, bold);
  }
  if (row.added) out->setForeground(0, QColor(0x2a, 0x8f, 0x57));
  return out;
}

}  // namespace

EffectList::EffectList(QWidget* parent) : QTreeWidget(parent) {
  setHeaderLabels({"effect", "probability", "explains", "error on unseen frames"});
  setRootIsDecorated(false);
  header()->setSectionResizeMode(QHeaderView::ResizeToContents);
}

void EffectList::show_rows(const std::vector<EffectRow>& rows) {
  const QTreeWidgetItem* before = currentItem();
  const QString selected = before != nullptr ? before->data(0, kEffectRole).toString() : QString();
  clear();
  for (const EffectRow& row : rows) {
    QTreeWidgetItem* line = item(row);
    addTopLevelItem(line);
    if (!selected.isEmpty() && text(row.effect) == selected) setCurrentItem(line);
  }
}

std::string EffectList::selected(bool added) const {
  const QTreeWidgetItem* row = currentItem();
  if (row == nullptr || row->data(0, kAddedRole).toBool() != added) return "";
  return row->data(0, kEffectRole).toString().toStdString();
}

}  // namespace tissue_stiffness
