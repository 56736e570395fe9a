//! Words for how a value was had, in the languages of the built-in dialects.

use super::words::normalised;
use crate::kes::ValueStatus::{self, Assumed, Doubtful, Inferred, Measured};

/// What the words mean, one line a language: English, German, French, Spanish, Italian, Portuguese, Dutch, Polish, Czech,
/// Turkish, Japanese, Chinese, Korean. What was estimated rests on something that nobody measured, and is assumed; what
/// was calculated rests on measurements.
const WORDS: [(ValueStatus, &str); 4] = [
    (
        Measured,
        "measured published reported tested experimental literature ok valid
         gemessen veröffentlicht Literatur
         mesuré mesurée publié publiée littérature
         medido medida publicado publicada literatura
         misurato misurata pubblicato pubblicata letteratura
         gemeten gepubliceerd literatuur
         zmierzone zmierzono zmierzony opublikowane opublikowano literaturowe
         změřeno naměřeno měřeno publikováno literatura
         ölçülen ölçüldü yayımlanan literatür
         測定 実測 測定値 実測値 文献値 公表値
         测量 实测 测定 实测值 文献值 已发表 測量 實測 測定 實測值 文獻值
         측정 측정값 실측 문헌값",
    ),
    (
        Inferred,
        "inferred calculated computed derived converted interpolated calc
         berechnet abgeleitet errechnet umgerechnet
         calculé calculée déduit déduite dérivé
         calculado calculada deducido deducida derivado
         calcolato calcolata dedotto dedotta derivato
         deduzido deduzida
         berekend afgeleid
         obliczone obliczono obliczony wyliczone
         vypočteno vypočítáno odvozeno
         hesaplanan hesaplandı türetilen
         計算 計算値 算出 換算
         计算 计算值 推算 換算 换算 計算值
         계산 계산값 환산",
    ),
    (
        Assumed,
        "assumed estimated guessed assumption estimate guess supposed default nominal est
         angenommen geschätzt vermutet
         supposé supposée estimé estimée
         supuesto supuesta asumido asumida estimado estimada
         assunto assunta stimato stimata ipotizzato
         assumido assumida suposto suposta
         aangenomen geschat
         przyjęte założone oszacowane przyjęto założono oszacowano
         předpokládáno odhadnuto odhad
         varsayılan tahmini tahmin
         仮定 推定 推定値 仮定値
         假定 假设 估计 估算 假設 估計
         가정 추정 추정값",
    ),
    (
        Doubtful,
        "doubtful questionable suspect uncertain unreliable dubious
         zweifelhaft fraglich unsicher
         douteux douteuse incertain
         dudoso dudosa incierto
         dubbio dubbia incerto
         duvidoso duvidosa incerto
         twijfelachtig onzeker
         wątpliwe niepewne
         pochybné nejisté
         şüpheli
         疑問 疑わしい 要確認
         可疑 存疑
         의심",
    ),
];

/// The status that a text names as a whole, or that it begins with: `estimated from Tm`, `published (Table 2)`.
pub(super) fn meaning(text: &str) -> Option<ValueStatus> {
    if text.trim() == "?" {
        return Some(Doubtful);
    }
    let first = text.split([' ', '_', '(', ',', ';', ':']).find(|word| !word.is_empty())?;
    exactly(text).or_else(|| exactly(first))
}

fn exactly(text: &str) -> Option<ValueStatus> {
    let word = normalised(text);
    WORDS.iter().find(|(_, words)| words.split_whitespace().any(|w| normalised(w) == word)).map(|of| of.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_several_languages_and_phrases_that_begin_with_them() {
        for (text, status) in [
            ("Measured", Some(Measured)),
            ("published (Table 2)", Some(Measured)),
            ("calculated", Some(Inferred)),
            ("Berechnet", Some(Inferred)),
            ("estimated from Tm", Some(Assumed)),
            ("guessed", Some(Assumed)),
            ("ASSUMED", Some(Assumed)),
            ("geschätzt", Some(Assumed)),
            ("推定", Some(Assumed)),
            ("可疑", Some(Doubtful)),
            ("doubtful", Some(Doubtful)),
            ("?", Some(Doubtful)),
            ("approved", None),
            ("not measured", None),
            ("", None),
        ] {
            assert_eq!(meaning(text), status, "{text}");
        }
    }

    /// A word of two meanings would give one of them by its place in the table.
    #[test]
    fn no_word_has_two_meanings() {
        for (status, words) in &WORDS {
            for word in words.split_whitespace() {
                assert_eq!(exactly(word), Some(*status), "{word}");
            }
        }
    }
}
