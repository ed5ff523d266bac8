"""The list of verbs in the language of the user's locale."""

import os

JAPANESE = {
    "abandon": "中断した実行を終わりにする",
    "answer": "実行からの確認(WaitForClick)を表示し、回答する",
    "cancel": "実行を中止し、機械の停止を確かめる",
    "check": "設定ファイルを点検する",
    "completion": "シェルの補完スクリプトを出力する",
    "db": "データベースをバックアップ・復元する",
    "demo": "シミュレーションの油圧ショベルで掘削を実演する",
    "down": "この PC のプロセスをすべて終える",
    "drill": "動作中に各プロセスを落として停止を試す",
    "events": "実行の記録を表示する",
    "logs": "プロセスのログを表示する",
    "palette": "Groot 用のノード一覧を出力する",
    "panel": "1 つのタスクの開始・停止ボタンを全画面で表示する",
    "param": "パラメータを表示・変更する",
    "prometheus": "Prometheus が監視する対象の一覧を書き出す",
    "sensing": "センシング入力の状態を表示する、記録(rosbag2)を再生する",
    "ps": "プロセスを一覧する",
    "rearm": "停止した機械を再び動ける状態にする",
    "restart": "プロセスを再起動する",
    "resume": "中断した実行を続ける",
    "run": "保存したタスクを実行する",
    "runs": "実行の履歴を一覧する",
    "start": "プロセスを起動する",
    "status": "すべて動いているかを表示する",
    "stop": "ソフト停止:すべて、または 1 台の機械を止める",
    "stop-process": "プロセスを止める",
    "task": "タスク(行動ツリー)を登録・点検する",
    "terrain": "地形(ハイトマップ・画像)を登録・取得する",
    "up": "この PC のプロセスを起動する",
    "user": "コンソールの利用者を登録する",
}


def japanese() -> bool:
    """Whether the locale asks for Japanese."""
    names = (os.environ.get(key) for key in ("LC_ALL", "LC_MESSAGES", "LANG"))
    return next((name.startswith("ja") for name in names if name), False)


def summary(verb: str, english: str) -> str:
    return JAPANESE.get(verb, english) if japanese() else english
